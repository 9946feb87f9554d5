"""What was deleted."""

from dataclasses import dataclass

from core.diagnosis.verdict import Verdict
from service.storage.states import DeletedBy, RecordingSource, RecordingState


@dataclass(frozen=True, slots=True)
class DeletedRows:
    """What one transaction deleted, and how long it had the writer to itself [s]."""

    rows: int
    took_s: float


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
