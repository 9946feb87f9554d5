"""What a relay measures all the time, found in its own data model: logical nodes MMXU and MSTA."""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum

from scl.data_model import Ied
from service.plant.offer import Offer


class MeteredQuantity(StrEnum):
    """A measured value of the motor's terminals, rms of the fundamental or as the relay defines it.

    AVERAGE_..., MAXIMUM_..., MINIMUM_...: the relay's own statistics, since somebody last reset them there.
    """

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
    AVERAGE_CURRENT = "average_current_A"
    MAXIMUM_CURRENT = "maximum_current_A"
    MINIMUM_CURRENT = "minimum_current_A"
    AVERAGE_VOLTAGE = "average_voltage_V"
    MAXIMUM_VOLTAGE = "maximum_voltage_V"
    MINIMUM_VOLTAGE = "minimum_voltage_V"
    AVERAGE_POWER = "average_power_W"
    MAXIMUM_POWER = "maximum_power_W"
    MINIMUM_POWER = "minimum_power_W"
    MAXIMUM_IA = "maximum_ia_A"
    MAXIMUM_IB = "maximum_ib_A"
    MAXIMUM_IC = "maximum_ic_A"
    MINIMUM_IA = "minimum_ia_A"
    MINIMUM_IB = "minimum_ib_A"
    MINIMUM_IC = "minimum_ic_A"
    MAXIMUM_VAB = "maximum_vab_V"
    MAXIMUM_VBC = "maximum_vbc_V"
    MAXIMUM_VCA = "maximum_vca_V"
    MINIMUM_VAB = "minimum_vab_V"
    MINIMUM_VBC = "minimum_vbc_V"
    MINIMUM_VCA = "minimum_vca_V"

    @property
    def is_statistic(self) -> bool:
        """Whether it changes slowly: the relay's own figure of a long time."""
        return self in _STATISTICS


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

_STATISTICS = {
    MeteredQuantity.AVERAGE_CURRENT: "AvAmps",
    MeteredQuantity.MAXIMUM_CURRENT: "MaxAmps",
    MeteredQuantity.MINIMUM_CURRENT: "MinAmps",
    MeteredQuantity.AVERAGE_VOLTAGE: "AvVolts",
    MeteredQuantity.MAXIMUM_VOLTAGE: "MaxVolts",
    MeteredQuantity.MINIMUM_VOLTAGE: "MinVolts",
    MeteredQuantity.AVERAGE_POWER: "AvW",
    MeteredQuantity.MAXIMUM_POWER: "MaxW",
    MeteredQuantity.MINIMUM_POWER: "MinW",
    MeteredQuantity.MAXIMUM_IA: "MaxA.phsA",
    MeteredQuantity.MAXIMUM_IB: "MaxA.phsB",
    MeteredQuantity.MAXIMUM_IC: "MaxA.phsC",
    MeteredQuantity.MINIMUM_IA: "MinA.phsA",
    MeteredQuantity.MINIMUM_IB: "MinA.phsB",
    MeteredQuantity.MINIMUM_IC: "MinA.phsC",
    MeteredQuantity.MAXIMUM_VAB: "MaxP2PV.phsAB",
    MeteredQuantity.MAXIMUM_VBC: "MaxP2PV.phsBC",
    MeteredQuantity.MAXIMUM_VCA: "MaxP2PV.phsCA",
    MeteredQuantity.MINIMUM_VAB: "MinP2PV.phsAB",
    MeteredQuantity.MINIMUM_VBC: "MinP2PV.phsBC",
    MeteredQuantity.MINIMUM_VCA: "MinP2PV.phsCA",
}
"""IEC 61850-7-4, MSTA; MaxA, MinA, MaxP2PV and MinP2PV are an extension of the SEL-700 family."""

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

    @property
    def stamp(self) -> str:
        """Reference of the relay's time of its latest change (IEC 61850-7-3, `t`; MX)."""
        value = next(each for each in _VALUES if self.reference.endswith(f".{each}"))
        return f"{self.reference.removesuffix(value)}t"


def measurands(ied: Ied) -> tuple[Measurand, ...]:
    """Each quantity once: as the first MMXU or MSTA that has it tells it."""
    return tuple(
        found for quantity in MeteredQuantity if (found := _first(_places(ied, quantity))) is not None
    )


def measurands_offered(offer: Offer, expected: Iterable[Measurand]) -> tuple[Measurand, ...]:
    """Each quantity once: where the SCL expects it if that is offered, else where the standard has it.

    Attributes are not looked up: who samples finds out whether they are there.
    """
    known = {each.quantity: each for each in expected if offer.has(each.reference)}
    found = (known.get(quantity) or _standard(offer, quantity) for quantity in MeteredQuantity)
    return tuple(each for each in found if each is not None)


def _standard(offer: Offer, quantity: MeteredQuantity) -> Measurand | None:
    ln_class, measured = _place(quantity)
    name, _, phase = measured.partition(".")
    value = _VALUES[0] if phase else _VALUES[1]
    for reference in offer.objects(ln_class, name):
        found = f"{reference}.{phase}" if phase else reference
        return Measurand(quantity, f"{found}.{value}", f"{found}.units.multiplier")
    return None


def _place(quantity: MeteredQuantity) -> tuple[str, str]:
    """Class of the logical nodes that tell a quantity, and the data object below them."""
    if quantity.is_statistic:
        return "MSTA", _STATISTICS[quantity]
    return "MMXU", _OBJECTS[quantity]


def _places(ied: Ied, quantity: MeteredQuantity) -> Iterable[Measurand]:
    ln_class, measured = _place(quantity)
    for node in ied.logical_nodes(ln_class):
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
