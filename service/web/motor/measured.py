"""What a motor's relay measured last, as tables."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from core.quantity_text import with_unit
from core.units import NANOSECONDS_PER_DAY
from service.plant import MeteredQuantity
from service.storage.records import Measurement

DIGITS: Final = 4
MEASURED_WITHIN_NS: Final = 30 * NANOSECONDS_PER_DAY
"""What was measured longer ago is not shown."""
WORDS: Final = {
    MeteredQuantity.POWER: "Power",
    MeteredQuantity.REACTIVE_POWER: "Reactive power",
    MeteredQuantity.POWER_FACTOR: "Power factor",
    MeteredQuantity.FREQUENCY: "Frequency",
}
PHASED: Final = {"i": "Current", "v": "Voltage"}
STATISTICS: Final = {"average": "Average", "maximum": "Largest", "minimum": "Smallest"}


@dataclass(frozen=True, slots=True)
class MeasuredValue:
    """A measured value in words."""

    name: str
    value: str


@dataclass(frozen=True, slots=True)
class MeasuredValues:
    """What was measured at a time, and the relay's own statistics, since somebody last reset them there."""

    time_ns: int
    now: Sequence[MeasuredValue]
    statistics: Sequence[MeasuredValue]


def measured_values(measurement: Measurement | None) -> MeasuredValues | None:
    """Return the values that the relay has; None where it has told none."""
    if measurement is None:
        return None
    known = [
        (quantity, value)
        for quantity in MeteredQuantity
        if (value := measurement.values.get(quantity.value)) is not None
    ]
    return MeasuredValues(
        measurement.time_ns,
        [_value(quantity, value) for quantity, value in known if not quantity.is_statistic],
        [_value(quantity, value) for quantity, value in known if quantity.is_statistic],
    )


def _value(quantity: MeteredQuantity, value: float) -> MeasuredValue:
    name, _, unit = quantity.value.rpartition("_")
    if quantity is MeteredQuantity.POWER_FACTOR:
        name, unit = "power_factor", ""
    return MeasuredValue(_words(quantity, name), with_unit(value, unit, DIGITS).strip())


def _words(quantity: MeteredQuantity, name: str) -> str:
    """Return the name of a quantity: `maximum_vab` is the largest voltage ab."""
    if quantity in WORDS:
        return WORDS[quantity]
    kind, _, rest = name.partition("_")
    if kind in STATISTICS:
        return f"{STATISTICS[kind]} {_phased(rest).lower()}"
    return _phased(name)


def _phased(name: str) -> str:
    if name in ("current", "voltage", "power"):
        return name.capitalize()
    return f"{PHASED[name[0]]} {name[1:]}"
