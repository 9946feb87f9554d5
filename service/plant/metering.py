"""Finds what a relay measures all the time in its data model: logical nodes MMXU and MSTA."""

from collections.abc import Iterable
from dataclasses import dataclass

from scl.ied_model import Ied
from service.plant.offer import Offer
from service.plant.quantities import MeteredQuantity

_VALUES = ("cVal.mag.f", "mag.f")
"""These are the attributes of complex and plain measured values (CMV, MV) in floating point."""


@dataclass(frozen=True, slots=True)
class Measurand:
    """Where a relay has a quantity.

    reference: of the value (functional constraint MX).
    multiplier: reference of the power of ten that the value is given in (CF); None where the model has none
    and the value is in plain units.
    """

    quantity: MeteredQuantity
    reference: str
    multiplier: str | None

    @property
    def stamp(self) -> str:
        """Return the reference of the time stamp of its latest change (IEC 61850-7-3, `t`; MX)."""
        value = next(each for each in _VALUES if self.reference.endswith(f".{each}"))
        return f"{self.reference.removesuffix(value)}t"


def measurands_from_scl(ied: Ied) -> tuple[Measurand, ...]:
    """Return each quantity once, from the first MMXU or MSTA that has it."""
    return tuple(
        found for quantity in MeteredQuantity if (found := _first(_places(ied, quantity))) is not None
    )


def measurands_from_offer(offer: Offer, expected: Iterable[Measurand]) -> tuple[Measurand, ...]:
    """Return each quantity once: where the SCL has it if that is offered, else where the standard has it.

    Attributes are not looked up here. Sampling shows whether they exist.
    """
    known = {each.quantity: each for each in expected if offer.has(each.reference)}
    found = (known.get(quantity) or _standard(offer, quantity) for quantity in MeteredQuantity)
    return tuple(each for each in found if each is not None)


def _standard(offer: Offer, quantity: MeteredQuantity) -> Measurand | None:
    name, _, phase = quantity.data_object.partition(".")
    value = _VALUES[0] if phase else _VALUES[1]
    for reference in offer.objects(quantity.logical_node, name):
        found = f"{reference}.{phase}" if phase else reference
        return Measurand(quantity, f"{found}.{value}", f"{found}.units.multiplier")
    return None


def _places(ied: Ied, quantity: MeteredQuantity) -> Iterable[Measurand]:
    measured = quantity.data_object
    for node in ied.logical_nodes(quantity.logical_node):
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
