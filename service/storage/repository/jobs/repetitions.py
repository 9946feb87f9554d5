"""Diagnosing an archive again: which recordings are to do, and what became of them."""

from collections.abc import Collection, Mapping

from sqlalchemy import ColumnElement, func, select
from sqlalchemy.orm import Session

from service.audit.actions import AuditAction
from service.storage.models import AuditEntryRow, BaselineRow, DiagnosisRow, JobRow, RecordingRow
from service.storage.records import Cursor, Job, Page
from service.storage.records.actors import Actor
from service.storage.repository.audit.entries import note_change
from service.storage.repository.jobs.queue import job
from service.storage.repository.recordings.recordings import new_job
from service.storage.repository.sessions import Order, Sessions, page_of
from service.storage.states import JobPriority, JobState, RecordingState

OPEN = (JobState.QUEUED, JobState.RUNNING)
EXAMINED = (RecordingState.DIAGNOSED, RecordingState.REJECTED, RecordingState.FAILED)
"""The first diagnosis of other recordings is still to come."""

CHANGES = (AuditAction.PARAMETERS_CHANGED, AuditAction.BASELINE_SET, AuditAction.BASELINE_DELETED)
"""A diagnosis that began before one of these was made with other figures of the motor."""


class RepetitionRows(Sessions):
    def repetitions_to_do(
        self, motor: str, *, method: str, model: str, made_before_ns: int = 0
    ) -> tuple[int, int]:
        """Return how many recordings of a motor are to be diagnosed again, and how many it has.

        A recording is done where its latest diagnosis was made in this way, began after the motor's
        parameters and baseline were changed for the last time, and not before `made_before_ns`, UTC [ns].
        """
        with self._read() as session:
            count = select(func.count()).select_from(RecordingRow).where(*_examined(motor))
            to_do = count.where(_is_to_do(session, motor, method, model, made_before_ns))
            return session.scalars(to_do).one(), session.scalars(count).one()

    def repeat_diagnoses(
        self,
        motor: str,
        *,
        method: str,
        model: str,
        made_before_ns: int = 0,
        by: Actor,
        now_ns: int,
        limit: int,
        after: Cursor | None = None,
    ) -> Page[Job]:
        """Queue diagnoses of the next recordings that `repetitions_to_do` counts, oldest first.

        A recording whose diagnosis is queued or under way already gets no other one: it is returned.
        """
        order: Order = [RecordingRow.announced_ns, RecordingRow.id]
        with self._write() as session:
            to_do = _is_to_do(session, motor, method, model, made_before_ns)
            query = select(RecordingRow).where(*_examined(motor), to_do)
            page = page_of(session, query.with_for_update(), order, lambda row: row, limit=limit, after=after)
            ids = [row.id for row in page.items]
            way = (JobRow.method == method, JobRow.model == model, JobRow.state.in_(OPEN))
            under_way = session.scalars(select(JobRow).where(JobRow.recording_id.in_(ids), *way))
            jobs = {row.recording_id: row for row in under_way}
            for recording in page.items:
                if recording.id in jobs:
                    continue
                row = new_job(recording, method, model, JobPriority.REPETITION, now_ns)
                session.add(row)
                jobs[recording.id] = row
                asked = {"diagnosis": row.id, "motor": motor, "method": method, "model": model}
                subject = ("recording", recording.id)
                note_change(session, by, AuditAction.DIAGNOSIS_REQUESTED, subject, now_ns=now_ns, after=asked)
            session.flush()
            return Page(tuple(job(jobs[id_]) for id_ in ids), page.next)

    def ended_jobs(self, ids: Collection[str]) -> Mapping[str, Job | None]:
        """Return those of these jobs that have ended; None for one whose recording was deleted."""
        with self._read() as session:
            rows = session.scalars(select(JobRow).where(JobRow.id.in_(ids)))
            jobs = {row.id: job(row) for row in rows}
        missing = dict.fromkeys(id_ for id_ in ids if id_ not in jobs)
        return {id_: one for id_, one in jobs.items() if one.state not in OPEN} | missing


def _examined(motor: str) -> tuple[ColumnElement[bool], ...]:
    """Choose the recordings of a motor that have files and have come to an end before."""
    return (
        RecordingRow.motor == motor,
        RecordingRow.digest.is_not(None),
        RecordingRow.state.in_(EXAMINED),
    )


def _is_to_do(
    session: Session, motor: str, method: str, model: str, made_before_ns: int
) -> ColumnElement[bool]:
    """Choose recordings whose latest diagnosis was made in another way, or too early."""
    changed_ns = session.scalar(
        select(func.max(AuditEntryRow.time_ns)).where(
            AuditEntryRow.subject_kind == "motor",
            AuditEntryRow.subject == motor,
            AuditEntryRow.action.in_(CHANGES),
        )
    )
    chosen_ns = session.scalar(select(BaselineRow.chosen_ns).where(BaselineRow.motor == motor))
    since_ns = max(made_before_ns, changed_ns or 0, chosen_ns or 0)
    is_done = (
        select(DiagnosisRow.id)
        .join(JobRow, JobRow.id == DiagnosisRow.job_id)
        .where(
            DiagnosisRow.recording_id == RecordingRow.id,
            DiagnosisRow.current,
            JobRow.method == method,
            JobRow.model == model,
            JobRow.started_ns >= since_ns,
        )
    )
    return ~is_done.exists()
