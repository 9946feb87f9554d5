"""What happened to a motor in a time, for its trend on pages and in mails: starts, trips, baseline, notes."""

from collections.abc import Mapping, Sequence
from typing import Final

from core.condition.events import EventKind
from core.operation import Operation
from core.terms import phrase
from core.units import NANOSECONDS_PER_SECOND
from service.pictures.trend import TrendMark
from service.storage import Repository
from service.storage.states import RelayEventKind

MOST_OF_EACH: Final = 40
"""The latest of each kind are marked; more would hide one another and the trend."""
SAME_NS: Final = 5 * NANOSECONDS_PER_SECOND
"""A record and the relay's sequence of events that are no farther apart tell of one event."""
OPERATIONS: Final[Mapping[Operation, str]] = {Operation.START: "start", Operation.TRIP: "trip"}


def trend_marks(repository: Repository, motor: str, from_ns: int, to_ns: int) -> list[TrendMark]:
    """Return what happened in the time, in its order."""
    marks = []
    for operation, label in OPERATIONS.items():
        found = repository.operations(motor, [operation], limit=MOST_OF_EACH, from_ns=from_ns, to_ns=to_ns)
        marks += [
            TrendMark(one.announced_ns if one.recorded_ns is None else one.recorded_ns, label)
            for one in found
        ]
    marks += _told_by_relay(repository, motor, from_ns, to_ns, marks)
    baseline = repository.baseline(motor)
    if baseline.chosen_ns is not None:
        marks.append(TrendMark(baseline.chosen_ns, "baseline"))
    notes = repository.events(motor, limit=MOST_OF_EACH).items
    marks += [
        TrendMark(one.time_ns, "note" if one.kind is EventKind.NOTE else phrase(one.kind))
        for one in notes
        if one.withdrawn_ns is None
    ]
    return sorted(
        (one for one in marks if from_ns <= one.time_ns < to_ns), key=lambda mark: (mark.time_ns, mark.words)
    )


def _told_by_relay(
    repository: Repository, motor: str, from_ns: int, to_ns: int, recorded: Sequence[TrendMark]
) -> list[TrendMark]:
    """Return starts, stops and trips of the relay's sequence of events that no record shows."""
    told = [
        TrendMark(event.time_ns, kind.value)
        for kind in RelayEventKind
        for event in repository.relay_events(motor, kind, limit=MOST_OF_EACH, from_ns=from_ns, to_ns=to_ns)
    ]
    return [
        one
        for one in told
        if not any(
            mark.words == one.words and abs(mark.time_ns - one.time_ns) <= SAME_NS for mark in recorded
        )
    ]
