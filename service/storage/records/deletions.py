"""What was deleted."""

from dataclasses import dataclass

from core.diagnosis.verdict import Verdict
from service.storage.records.actors import Actor
from service.storage.states import DeletedBy, RecordingSource, RecordingState, StayReason


@dataclass(frozen=True, slots=True)
class DeletedRows:
    """What one transaction deleted, and how long it had the writer to itself [s]."""

    rows: int
    took_s: float


@dataclass(frozen=True, slots=True)
class AppliedRule:
    """The setting whose rule deletes something, who applies it, and when: for the audit trail."""

    setting: str
    by: Actor
    now_ns: int


@dataclass(frozen=True, slots=True)
class Amount:
    """So many rows of about this size, from the oldest to the newest; the times are None without rows."""

    rows: int
    size_bytes: int
    oldest_ns: int | None
    newest_ns: int | None

    def plus(self, other: "Amount") -> "Amount":
        """Return both together."""
        times = [
            time
            for time in (self.oldest_ns, self.newest_ns, other.oldest_ns, other.newest_ns)
            if time is not None
        ]
        return Amount(
            self.rows + other.rows,
            self.size_bytes + other.size_bytes,
            min(times, default=None),
            max(times, default=None),
        )


@dataclass(frozen=True, slots=True)
class OldRecording:
    """A recording that a rule is old enough to delete. stays: why it does not; None where it does."""

    id: str
    motor: str
    name: str
    size_bytes: int
    announced_ns: int
    recorded_ns: int | None
    stays: StayReason | None


@dataclass(frozen=True, slots=True)
class Deletion:
    """A recording that was deleted: what it was when it was deleted, when, by whom and why."""

    id: str
    motor: str
    ied: str | None
    source: RecordingSource
    name: str
    digest: str | None
    size_bytes: int
    state: RecordingState
    verdict: Verdict | None
    announced_ns: int
    recorded_ns: int | None
    deleted_ns: int
    deleted_by: DeletedBy
    reason: str
