"""Starts of a motor beside its first ones: what has changed, and why."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from core.condition.events import EventKind
from core.starts.changes import compare_starts
from core.starts.compared import StartChanges
from core.starts.stress import HOUR_NS, starts_within_hour
from service.storage import Repository
from service.storage.records import ConditionEvent, StartEntry
from service.storage.states import StartSource

MOST_EVENTS: Final = 1000
RENEWING: Final = (EventKind.REWOUND, EventKind.REFERENCE_RESTARTED, EventKind.RECORDER_CHANGED)
"""After these a start is compared with the first ones that come then."""
LATEST: Final = 3
"""Latest starts that are taken together, to tell a small change from the scatter of single ones."""


@dataclass(frozen=True, slots=True)
class Reference:
    """What the starts of a motor are compared with: recorded ones or, where there are none, reported ones.

    A relay measures its acceleration time by another rule, so that starts of both kinds are not compared.

    renewed: what made the reference begin anew; None where nothing did.
    """

    starts: Sequence[StartEntry]
    renewed: ConditionEvent | None

    def holds(self, entry: StartEntry) -> bool:
        """Return whether a start is one of the reference, or was before it."""
        renewed = self.renewed is not None and entry.time_ns < self.renewed.time_ns
        return renewed or any(entry.recording_id == one.recording_id for one in self.starts)

    def is_like(self, entry: StartEntry) -> bool:
        """Return whether a start is told by what tells of the reference; without one, any is."""
        return not self.starts or entry.source is self.starts[0].source

    def compared(self, entries: Sequence[StartEntry]) -> StartChanges | None:
        """Return how starts, taken together, differ from the reference; None for those that belong to it."""
        later = [entry for entry in entries if self.is_like(entry) and not self.holds(entry)]
        if not later:
            return None
        return compare_starts([one.examined for one in later], [one.examined for one in self.starts])


def reference_of(repository: Repository, motor: str) -> Reference:
    """Return what the starts of a motor are compared with."""
    events = repository.events(motor, limit=MOST_EVENTS).items
    renewed = next((one for one in events if one.kind in RENEWING and one.withdrawn_ns is None), None)
    from_ns = 0 if renewed is None else renewed.time_ns
    first = repository.first_whole_starts(motor, from_ns=from_ns) or repository.first_whole_starts(
        motor, from_ns=from_ns, source=StartSource.REPORT
    )
    return Reference(first, renewed)


def within_hour(repository: Repository, entries: Sequence[StartEntry]) -> dict[str, int]:
    """Return how many starts there were in the hour up to each of these of one motor, by recording."""
    if not entries:
        return {}
    times = [one.time_ns for one in entries]
    known = repository.times_of_starts(entries[0].motor, from_ns=min(times) - HOUR_NS, to_ns=max(times))
    return {one.recording_id: starts_within_hour(known, one.time_ns) for one in entries}
