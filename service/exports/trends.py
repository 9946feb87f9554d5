"""The table of trends: of each recording what it says by itself, and what is said of the motor from it on.

What it says by itself is of the winding, the rotor, the air gap and the load, and the supply.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from heapq import merge
from itertools import chain, groupby
from operator import attrgetter
from typing import Any, Final

from core.quantities import QUANTITIES, Quantity, Subject, of_subject
from service.exports.paging import PAGE, pages
from service.exports.tables import Column, ColumnType, Table, text, time
from service.storage.records.history import SubjectPoint
from service.storage.repository import Repository


@dataclass(slots=True)
class TrendRow:
    """A recording, with what it tells of each subject; a subject of which it tells nothing is not there."""

    motor: str
    time_ns: int
    recording_id: str
    told: dict[Subject, Sequence[Any]] = field(default_factory=dict)


_PLACES: Final[Mapping[str, int]] = {
    one.name: place for subject in Subject for place, one in enumerate(of_subject(subject))
}
"""Where a figure stands in what is told of its subject."""


def _column(quantity: Quantity) -> Column[TrendRow]:
    subject, place = quantity.subject, _PLACES[quantity.name]

    def value(row: TrendRow) -> Any:
        values = row.told.get(subject)
        return None if values is None else values[place]

    column_type = ColumnType.NUMBER
    if quantity.is_word:
        column_type = ColumnType.TEXT
    elif quantity.is_whole:
        column_type = ColumnType.WHOLE
    return Column(quantity.name, column_type, quantity.unit, quantity.meaning, value)


TABLE: Table[TrendRow] = Table(
    "trend",
    (
        text("motor", "motor", attrgetter("motor")),
        time("time", "trigger time written in the record", attrgetter("time_ns")),
        *map(_column, QUANTITIES),
        text("recording_id", "id of the recording", attrgetter("recording_id")),
    ),
)


def trends(
    repository: Repository, motors: Sequence[str], *, from_ns: int | None = None, to_ns: int | None = None
) -> Iterator[Sequence[TrendRow]]:
    """Return the trends of motors, one motor after another, oldest first, from_ns <= time < to_ns."""
    for motor in motors:
        read = partial(repository.subject_trend, motor, from_ns=from_ns, to_ns=to_ns)
        sources = [_points(subject, partial(read, subject)) for subject in Subject]
        yield from _joined(motor, merge(*sources, key=lambda one: one[1].time_ns))


def _points(subject: Subject, read: Any) -> Iterator[tuple[Subject, SubjectPoint]]:
    return ((subject, point) for point in chain.from_iterable(pages(read)))


def _joined(motor: str, points: Iterator[tuple[Subject, SubjectPoint]]) -> Iterator[Sequence[TrendRow]]:
    """Return a row for each recording of which there is a point; they are in the order of time."""
    batch: list[TrendRow] = []
    for time_ns, together in groupby(points, key=lambda one: one[1].time_ns):
        rows: dict[str, TrendRow] = {}
        for subject, point in together:
            row = rows.setdefault(point.recording_id, TrendRow(motor, time_ns, point.recording_id))
            row.told[subject] = point.values
        batch += rows.values()
        if len(batch) >= PAGE:
            yield batch
            batch = []
    yield batch
