"""Starts of a motor within an hour."""

from collections.abc import Sequence

from core.starts.stress import HOUR_NS, starts_within_hour
from service.storage import Repository
from service.storage.records import StartEntry


def within_hour(repository: Repository, entries: Sequence[StartEntry]) -> dict[str, int]:
    """Return how many starts there were in the hour up to each of these of one motor, by recording."""
    if not entries:
        return {}
    times = [one.time_ns for one in entries]
    known = repository.times_of_starts(entries[0].motor, from_ns=min(times) - HOUR_NS, to_ns=max(times))
    return {one.recording_id: starts_within_hour(known, one.time_ns) for one in entries}
