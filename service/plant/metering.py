"""What a relay measures all the time, found in its own data model: logical nodes of class MMXU."""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum

from scl.data_model import Ied


class MeteredQuantity(StrEnum):
    """A measured value of the motor's terminals, rms of the fundamental or as the relay defines it."""

    IA = "ia_A"
    IB = "ib_A"
    IC = "ic_A"
    VAB = "vab_V"
    VBC = "vbc_V"
    VCA = "vca_V"
    VA = "va_V"
    VB = "vb_V"
    VC = "vc_V"
    POWER = "power_W"
    REACTIVE_POWER = "reactive_power_var"
    POWER_FACTOR = "power_factor"
    FREQUENCY = "frequency_Hz"


_OBJECTS = {
    MeteredQuantity.IA: "A.phsA",
    MeteredQuantity.IB: "A.phsB",
    MeteredQuantity.IC: "A.phsC",
    MeteredQuantity.VAB: "PPV.phsAB",
    MeteredQuantity.VBC: "PPV.phsBC",
    MeteredQuantity.VCA: "PPV.phsCA",
    MeteredQuantity.VA: "PhV.phsA",
    MeteredQuantity.VB: "PhV.phsB",
    MeteredQuantity.VC: "PhV.phsC",
    MeteredQuantity.POWER: "TotW",
    MeteredQuantity.REACTIVE_POWER: "TotVAr",
    MeteredQuantity.POWER_FACTOR: "TotPF",
    MeteredQuantity.FREQUENCY: "Hz",
}
"""IEC 61850-7-4, MMXU."""

_VALUES = ("cVal.mag.f", "mag.f")
"""Complex and plain measured values (CMV, MV) as floating point."""


@dataclass(frozen=True, slots=True)
class Measurand:
    """Where a relay tells a quantity.

    reference: of the value (functional constraint MX).  multiplier: of the power of ten it is given in (CF),
    None where the model has none and the value is in plain units.
    """

    quantity: MeteredQuantity
    reference: str
    multiplier: str | None


def measurands(ied: Ied) -> tuple[Measurand, ...]:
    """Each quantity once: as the first MMXU that has it tells it."""
    return tuple(
        found for quantity in MeteredQuantity if (found := _first(_places(ied, quantity))) is not None
    )


def _places(ied: Ied, quantity: MeteredQuantity) -> Iterable[Measurand]:
    measured = _OBJECTS[quantity]
    for node in ied.logical_nodes("MMXU"):
        for value in _VALUES:
            if node.find(f"{measured}.{value}") is not None:
                multiplier = f"{measured}.units.multiplier"
                yield Measurand(
                    quantity,
                    f"{node.reference}.{measured}.{value}",
                    None if node.find(multiplier) is None else f"{node.reference}.{multiplier}",
                )


def _first(found: Iterable[Measurand]) -> Measurand | None:
    return next(iter(found), None)
