"""The steps of a job from one state to another, inside a transaction."""

from sqlalchemy.orm import Session

from core.units import NANOSECONDS_PER_SECOND
from service.storage.models import JobRow, RecordingRow
from service.storage.repository.recordings.requests import fail_rows
from service.storage.repository.sessions import found
from service.storage.states import JobState, RecordingState
from service.storage.texts import storable


def end_job(row: JobRow, state: JobState, error: str | None, now_ns: int) -> None:
    """End a job, done or failed."""
    row.state = state
    row.error = None if error is None else storable(error)
    row.finished_ns = now_ns


def give_up_job(session: Session, row: JobRow, state: RecordingState, reason: str, now_ns: int) -> None:
    """End a job without a result. A recording that has an earlier diagnosis keeps it."""
    end_job(row, JobState.FAILED, reason, now_ns)
    recording = found(session, RecordingRow, row.recording_id, "recording", lock=True)
    if recording.state is not RecordingState.DIAGNOSED:
        recording.state = state
        recording.reason = storable(reason)
    fail_rows(session, recording.id, reason, now_ns)


def is_held(row: JobRow, runner: str) -> bool:
    """Tell whether the runner is at this job."""
    return row.state is JobState.RUNNING and row.runner == runner


def release(row: JobRow) -> None:
    """Queue a running job again as if it had not been claimed."""
    row.state = JobState.QUEUED
    row.runner = None
    row.attempts -= 1


def retry_or_give_up(
    session: Session, row: JobRow, error: str, *, now_ns: int, max_attempts: int, pause_s: float
) -> None:
    """Queue a running job again, or give it up after so many attempts."""
    if row.attempts >= max_attempts:
        reason = f"gave up after {row.attempts} attempts: {error}"
        give_up_job(session, row, RecordingState.FAILED, reason, now_ns)
        return
    row.state = JobState.QUEUED
    row.runner = None
    row.error = storable(error)
    row.finished_ns = now_ns
    row.not_before_ns = now_ns + round(pause_s * NANOSECONDS_PER_SECOND)
