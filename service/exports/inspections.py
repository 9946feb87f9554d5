"""The table of inspections."""

from collections.abc import Iterator, Sequence
from functools import partial
from operator import attrgetter

from service.exports.paging import pages
from service.exports.tables import Table, text, time, whole
from service.storage.records import Inspection
from service.storage.repository import Repository

TABLE: Table[Inspection] = Table(
    "inspections",
    (
        time("time", "when the motor was inspected", attrgetter("time_ns")),
        text("motor", "motor", attrgetter("motor")),
        text("kind", "kind of finding that had been said; none for nothing", attrgetter("kind")),
        text("finding", "what had been said", attrgetter("finding")),
        text("outcome", "confirmed, other-cause or nothing-found", attrgetter("outcome")),
        text("cause", "what it was, where that is something else", attrgetter("cause")),
        text("text", "what was found, in words", attrgetter("text")),
        whole("pictures", "1", "number of pictures", attrgetter("pictures")),
        text("alarm_id", "alarm that it was about", attrgetter("alarm_id")),
        text("by", "who told it", attrgetter("who")),
        time("made_time", "when they told it", attrgetter("made_ns")),
        time("withdrawn_time", "when it was withdrawn; empty while it counts", attrgetter("withdrawn_ns")),
        text("withdrawn_by", "who withdrew it", attrgetter("withdrawn_account")),
        text("withdrawn_reason", "why", attrgetter("withdrawn_reason")),
        text("inspection_id", "id of the inspection", attrgetter("id")),
    ),
)


def inspections(repository: Repository, motors: Sequence[str] | None) -> Iterator[Sequence[Inspection]]:
    """Return the inspections of these motors, one motor after another, or of all; latest first."""
    for motor in motors or (None,):
        yield from pages(partial(repository.inspections, motor))
