"""The table of what the relays measure all the time."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from operator import attrgetter

from service.exports.paging import pages
from service.exports.tables import Column, Table, number, text, time, whole
from service.plant import AveragingStep, MeteredQuantity
from service.storage.records import Measurement
from service.storage.repository import Repository


@dataclass(frozen=True, slots=True)
class MotorMeasurement:
    """What was measured of a motor at a time."""

    motor: str
    measured: Measurement


def _column(quantity: MeteredQuantity) -> Column[MotorMeasurement]:
    name = quantity.value
    words, _, unit = name.rpartition("_")
    if not words or unit == "factor":
        words, unit = name, "1"
    place = f"{quantity.logical_node}.{quantity.data_object}"
    return number(name, unit, f"{words.replace('_', ' ')} ({place})", lambda row: row.measured.values[name])


TABLE: Table[MotorMeasurement] = Table(
    "measurements",
    (
        text("motor", "motor", attrgetter("motor")),
        time("time", "when it was measured, or the beginning of the means", attrgetter("measured.time_ns")),
        whole("samples", "1", "how many values the means are of", attrgetter("measured.samples")),
        text(
            "source", "polled by the service, or from the relay's load profile", attrgetter("measured.source")
        ),
        *(_column(quantity) for quantity in MeteredQuantity),
    ),
)


def measurements(
    repository: Repository,
    motors: Sequence[str],
    step: AveragingStep,
    *,
    from_ns: int | None = None,
    to_ns: int | None = None,
) -> Iterator[Sequence[MotorMeasurement]]:
    """Return the measurements of motors, one motor after another, oldest first, from_ns <= time < to_ns."""
    for motor in motors:
        for found in pages(partial(repository.measurements, motor, int(step), from_ns=from_ns, to_ns=to_ns)):
            yield [MotorMeasurement(motor, one) for one in found]
