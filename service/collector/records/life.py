"""The life of one listed record, from the first look at it to the store or its refusal."""

from collections import Counter
from dataclasses import dataclass, field
from enum import StrEnum

from service.collector.records.listing import ListedRecord
from service.collector.records.policy import Failure, FailureRule
from service.storage.records import RemoteRecord


class Life(StrEnum):
    """Where a listed record stands. docs/reference/record-life.md shows what leads to what."""

    LISTED = "listed"
    SETTLING = "settling"
    UNSTEADY = "unsteady"
    READY = "ready"
    RETRYING = "retrying"
    INCOMPLETE = "incomplete"
    STORED = "stored"
    REFUSED = "refused"
    DELETED = "deleted"


DECIDED = frozenset({Life.STORED, Life.REFUSED, Life.DELETED})
"""Nothing more is asked of the relay for records that stand here."""

WHOLE = frozenset({Life.READY, Life.RETRYING})
"""Records that stand here have come whole and stood still for long enough."""


@dataclass(frozen=True, slots=True)
class SettlingTimes:
    """How long a record must stand still, may lack a file, and may go on changing [s]."""

    still_s: float
    incomplete_s: float
    unsteady_s: float


@dataclass(eq=False, slots=True)
class RecordState:
    """What is known of one record as it is listed. A record that changes is listed as another one.

    in_store: its files were stored under this listing, though they may have been deleted since. While its
    life is then neither `stored` nor `deleted`, it is pulled once more, because it may be another record by
    now.
    since_s: since when it stands still.  first_s: since when a record of its name has been waited for. Both
    are None while it is not waited for.  due_s: when it may be asked for again.  Times are monotonic [s].
    failures: attempts since the collector started, by kind.  reason: why the latest one failed.
    """

    record: ListedRecord
    life: Life = Life.LISTED
    in_store: bool = False
    since_s: float | None = None
    first_s: float | None = None
    due_s: float = 0.0
    failures: Counter[Failure] = field(default_factory=Counter)
    reason: str | None = None
    remote: RemoteRecord = field(init=False)

    def __post_init__(self) -> None:
        self.remote = remote_of(self.record)

    @property
    def name(self) -> str:
        return self.record.name

    @property
    def is_decided(self) -> bool:
        """Return whether nothing more is asked of the relay."""
        return self.life in DECIDED

    @property
    def attempts(self) -> int:
        """Return how many attempts failed since the collector started."""
        return self.failures.total()

    def settle(self, now_s: float, times: SettlingTimes) -> None:
        """Judge a record that is waited for, by whether it has come whole and stopped changing."""
        if self.life in WHOLE or self.life is Life.INCOMPLETE:
            return
        if self.since_s is None:
            self.since_s = now_s
        if self.first_s is None:
            self.first_s = now_s
        still_s = now_s - self.since_s
        if self.record.missing and still_s >= times.incomplete_s:
            self.life = Life.INCOMPLETE
        elif not self.record.missing and still_s >= times.still_s:
            self.life = Life.READY
        elif self.since_s - self.first_s >= times.unsteady_s:
            self.life = Life.UNSTEADY
        else:
            self.life = Life.SETTLING

    def fail(self, failure: Failure, reason: str, now_s: float, rule: FailureRule) -> None:
        """Note a failed attempt. The pause grows with every failure, of whatever kind."""
        self.failures[failure] += 1
        self.reason = reason
        if rule.pause is not None:
            self.life = Life.RETRYING
            self.due_s = now_s + rule.pause.pause_s(self.attempts)

    def pause_s(self, now_s: float) -> float:
        """Return how long the record is not asked for [s]; 0 or less when it may be."""
        return self.due_s - now_s if self.life is Life.RETRYING else 0.0

    def begin_anew(self, life: Life) -> None:
        """Enter this life, and forget what was waited for and what failed before."""
        self.life = life
        self.since_s = self.first_s = self.reason = None
        self.due_s = 0.0
        self.failures.clear()


def remote_of(record: ListedRecord) -> RemoteRecord:
    """Return a listed record as the database knows it."""
    return RemoteRecord(record.name, record.size_bytes, record.modified_ns)


def in_turn(states: list[RecordState], now_s: float) -> list[RecordState]:
    """Return the records that may be asked for now.

    Those that failed most come last, because they may end the visit again.
    """
    due = [state for state in states if state.pause_s(now_s) <= 0]
    return sorted(due, key=lambda state: state.attempts)
