"""The queue of diagnoses to be made, and their results."""

import json
import uuid
from collections.abc import Mapping, Sequence

from sqlalchemy import Select, bindparam, func, literal_column, or_, select, update
from sqlalchemy.orm import joinedload

from core.condition.copies import Outline
from core.diagnosis.methods import DEFAULT_METHOD, DEFAULT_MODEL
from core.diagnosis.verdict import Diagnosis, Verdict, not_finite
from core.findings.findings import Findings
from core.operation import AT_REST, EXPECTED
from service.audit.actions import AuditAction
from service.storage.errors import (
    NotFoundError,
    RunnerEndedError,
    StateConflictError,
    UnstorableDiagnosisError,
)
from service.storage.models import (
    Base,
    DiagnosisRow,
    JobRow,
    JobRunnerRow,
    RecordingRequestRow,
    RecordingRow,
)
from service.storage.records import ClaimedJob, Cursor, DiagnosisEntry, Job, JobResult, Page
from service.storage.records.actors import SERVICE, Actor
from service.storage.repository.audit.entries import note_change
from service.storage.repository.conditions.conditions import note_standstill
from service.storage.repository.conditions.observations import keep_observation
from service.storage.repository.history.record_figures import keep_record_figures
from service.storage.repository.history.rotor import keep_rotor_finding
from service.storage.repository.history.starts import keep_start
from service.storage.repository.jobs.locks import lock_motor_of
from service.storage.repository.jobs.steps import end_job, give_up_job, is_held, release, retry_or_give_up
from service.storage.repository.recordings.baselines import baseline_rows
from service.storage.repository.recordings.copies import settle_copies
from service.storage.repository.recordings.recordings import new_job, require_room
from service.storage.repository.recordings.requests import diagnose_rows
from service.storage.repository.recordings.series import OF_A_SERIES, is_counted_part
from service.storage.repository.relays.clocks import withdraw_clock
from service.storage.repository.sessions import Order, Sessions, found, only, page_of, record_of
from service.storage.states import JobPriority, JobState, RecordingSource, RecordingState
from service.storage.texts import storable
from service.timing.backoff import Backoff

MOST_DOCUMENT_BYTES = 256 * 1024
"""A diagnosis takes some 10 kB. A larger document says nothing that anybody could read."""

LATEST_NS = 2**63 - 1
"""Times are integers of 64 bits in the database."""


# The state as a literal: SQLite takes the index of the queued jobs for no parameter.
_IS_QUEUED = select(JobRow.id).where(JobRow.state == literal_column(f"'{JobState.QUEUED}'")).limit(1)

_DIAGNOSES = Base.metadata.tables[DiagnosisRow.__tablename__]
_NOT_CURRENT = (
    update(_DIAGNOSES).where(_DIAGNOSES.c.recording_id == bindparam("of_recording")).values(current=False)
)


class JobRows(Sessions):
    def request_diagnosis(
        self,
        recording_id: str,
        *,
        by: Actor = SERVICE,
        now_ns: int,
        method: str = DEFAULT_METHOD,
        model: str = DEFAULT_MODEL,
        most_queued: int | None = None,
    ) -> Job:
        """Queue a new diagnosis of a recording.

        most_queued: so many diagnoses of the motor may be queued. Raises NotFoundError,
        StateConflictError (not stored), TooManyWaitingError.
        """
        with self._write() as session:
            recording = found(session, RecordingRow, recording_id, "recording", lock=True)
            if recording.digest is None:
                raise StateConflictError(
                    "recording", recording_id, present=recording.state, wanted=RecordingState.DIAGNOSED
                )
            if most_queued is not None:
                require_room(session, recording.motor, most_queued)
            row = new_job(recording, method, model, JobPriority.REPETITION, now_ns)
            session.add(row)
            session.flush()
            note_change(
                session,
                by,
                AuditAction.DIAGNOSIS_REQUESTED,
                ("recording", recording_id),
                now_ns=now_ns,
                after={"diagnosis": row.id, "motor": recording.motor, "method": method, "model": model},
            )
            return job(row)

    def claim_job(self, *, now_ns: int, runner: str) -> ClaimedJob | None:
        """Take the next job that is due, by priority: it is running from now on, one attempt more.

        One that was queued later than now is of a time before the clock was set back: it is due.
        runner: a registered runner, whose job it is from now on. Raises RunnerEndedError where a job waits.
        """
        with self._read() as session:  # nearly always there is none: nobody who writes waits for that look
            if session.scalar(_IS_QUEUED) is None:
                return None
        queued_ns = func.coalesce(JobRow.finished_ns, JobRow.created_ns)
        is_due = or_(JobRow.not_before_ns <= now_ns, queued_ns > now_ns)
        query = (
            select(JobRow)
            .where(JobRow.state == JobState.QUEUED, is_due)
            .order_by(JobRow.priority, JobRow.not_before_ns, JobRow.id)
            .with_for_update(skip_locked=True)
        )
        with self._write() as session:
            if session.get(JobRunnerRow, runner, with_for_update=True) is None:
                raise RunnerEndedError(runner)
            row = only(session, query)
            if row is None:
                return None
            row.state = JobState.RUNNING
            row.runner = runner
            row.attempts += 1
            row.started_ns, row.finished_ns = now_ns, None
            recording = found(session, RecordingRow, row.recording_id, "recording")
            if recording.digest is None:
                raise StateConflictError(
                    "recording", recording.id, present=recording.state, wanted="diagnosed"
                )
            healthy = baseline_rows(session, recording.motor)
            digests = tuple(one.digest for one in healthy if one.digest is not None)
            triggered_ns = session.scalar(
                select(func.max(RecordingRequestRow.triggered_ns)).where(
                    RecordingRequestRow.recording_id == recording.id
                )
            )
            return ClaimedJob(
                job(row),
                recording.motor,
                recording.digest,
                digests,
                ied=recording.ied,
                triggered_ns=triggered_ns,
                announced_ns=recording.announced_ns,
                is_repetition=row.priority == JobPriority.REPETITION,
                is_joined=recording.source is RecordingSource.JOINED,
            )

    def release_job(self, job_id: str, *, runner: str) -> None:
        """Put a running job of the runner back as if it had not been claimed. Raises NotFoundError."""
        with self._write() as session:
            row = found(session, JobRow, job_id, "job", lock=True)
            if is_held(row, runner):
                release(row)

    def finish_job(
        self,
        job_id: str,
        findings: Findings,
        *,
        recorded_ns: int,
        now_ns: int,
        runner: str,
        left_out: str | None = None,
        outline: Outline | None = None,
    ) -> bool:
        """Keep what a record tells: diagnosis, figures, job, recording and requests in one transaction.

        Again changes nothing. recorded_ns: trigger time written in the record.  left_out: why it does not
        count for its motor's condition, nor in trends, for people.  outline: what tells copies of its event,
        of which the finest counts; None where it has no copies.
        Returns False, and keeps nothing, where the job is not the runner's any more.
        Raises NotFoundError, UnstorableDiagnosisError.
        """
        diagnosis, observation, start = findings.diagnosis, findings.observation, findings.start
        with self._write() as session:
            lock_motor_of(session, job_id)
            row = found(session, JobRow, job_id, "job", lock=True)
            if row.state is JobState.DONE:
                return row.runner == runner
            if not is_held(row, runner):
                return False
            recording = found(session, RecordingRow, row.recording_id, "recording", lock=True)
            earlier = session.connection().execute(_NOT_CURRENT, {"of_recording": recording.id})
            is_first = earlier.rowcount == 0  # nothing is kept of the recording that this one replaces
            if left_out is not None:
                outline = None
            copy_of = settle_copies(session, recording, outline, now_ns, is_first=is_first)
            if copy_of is not None:
                observation, start, left_out = None, None, copy_of
            remark = left_out
            if observation is not None and is_counted_part(session, recording, recorded_ns):
                observation, remark = None, OF_A_SERIES
            document = _document(findings)
            told = _diagnosis_row(row, recording.motor, diagnosis, document, recorded_ns, now_ns)
            told.says_nothing = told.says_nothing or copy_of is not None
            session.add(told)
            end_job(row, JobState.DONE, None, now_ns)
            recording.state = RecordingState.DIAGNOSED
            recording.reason = None if remark is None else storable(remark)
            recording.recorded_ns = recorded_ns
            recording.operation = diagnosis.operation
            unused = findings.not_commissioned_from
            recording.operation_remark = None if unused is None else storable(unused)
            if findings.duration_s is not None:
                recording.duration_s, recording.pre_trigger_s = findings.duration_s, findings.pre_trigger_s
            withdraw_clock(recording)
            session.flush()
            diagnose_rows(session, recording.id, now_ns)
            keep_observation(session, recording.id, recording.motor, observation, is_first=is_first)
            keep_start(session, recording.id, recording.motor, recorded_ns, start, is_first=is_first)
            shown = (session, recording.id, recording.motor, recorded_ns)
            counts = left_out is None
            tells_of_rotor = counts and diagnosis.verdict is not Verdict.UNDIAGNOSABLE
            keep_rotor_finding(*shown, findings.rotor if tells_of_rotor else None, is_first=is_first)
            figures = findings.beside_stator(of_rotor=tells_of_rotor) if counts else {}
            keep_record_figures(*shown, figures, is_first=is_first)
            if diagnosis.operation in AT_REST:
                note_standstill(session, recording.motor, min(recorded_ns, now_ns))
            return True

    def reject_recording(self, job_id: str, reason: str, *, now_ns: int, runner: str) -> None:
        """End a job whose record cannot be read: trying again would not help. Raises NotFoundError.

        No change where the job is not the runner's any more.
        """
        with self._write() as session:
            row = found(session, JobRow, job_id, "job", lock=True)
            if is_held(row, runner):
                give_up_job(session, row, RecordingState.REJECTED, reason, now_ns)

    def retry_or_fail_job(
        self,
        job_id: str,
        error: str,
        *,
        now_ns: int,
        max_attempts: int,
        backoff: Backoff,
        runner: str,
    ) -> JobState:
        """Queue a job again after a pause, or give it up after `max_attempts`; no change without the lease.

        Returns the state the job is in now. Raises NotFoundError.
        """
        with self._write() as session:
            row = found(session, JobRow, job_id, "job", lock=True)
            if is_held(row, runner):
                pause_s = backoff.pause_s(row.attempts)
                retry_or_give_up(
                    session, row, error, now_ns=now_ns, max_attempts=max_attempts, pause_s=pause_s
                )
            return row.state

    def job(self, recording_id: str, job_id: str) -> JobResult:
        """Return a job of this recording. Raises NotFoundError."""
        query = _with_result(recording_id).where(JobRow.id == job_id)
        with self._read() as session:
            found(session, RecordingRow, recording_id, "recording")
            row = only(session, query)
            if row is None:
                raise NotFoundError("diagnosis", job_id)
            return _job_result(row)

    def jobs(self, recording_id: str, *, limit: int, after: Cursor | None = None) -> Page[JobResult]:
        """Return the jobs of a recording, latest first. Raises NotFoundError."""
        order: Order = [JobRow.created_ns, JobRow.id]
        with self._read() as session:
            found(session, RecordingRow, recording_id, "recording")
            query = _with_result(recording_id)
            return page_of(session, query, order, _job_result, limit=limit, after=after, descending=True)

    def current_diagnosis(self, recording_id: str) -> DiagnosisEntry | None:
        """Return the latest result for a recording; None without one."""
        query = select(DiagnosisRow).where(DiagnosisRow.recording_id == recording_id, DiagnosisRow.current)
        with self._read() as session:
            row = only(session, query)
            return None if row is None else record_of(DiagnosisEntry, row)

    def verdicts(self, recording_ids: Sequence[str]) -> Mapping[str, Verdict]:
        """Return the latest verdict of each of these recordings that has one, by the recording's id."""
        query = select(DiagnosisRow.recording_id, DiagnosisRow.verdict).where(
            DiagnosisRow.recording_id.in_(recording_ids), DiagnosisRow.current
        )
        with self._read() as session:
            return {row.recording_id: row.verdict for row in session.execute(query)}


def _diagnosis_row(
    row: JobRow,
    motor: str,
    diagnosis: Diagnosis,
    document: Mapping[str, object],
    recorded_ns: int,
    now_ns: int,
) -> DiagnosisRow:
    if abs(recorded_ns) > LATEST_NS:
        raise UnstorableDiagnosisError(f"the record's time, {recorded_ns:.3g} ns, is beyond the year 2262")
    unknown = (None, None)
    level_low, level_high = diagnosis.mu_f_ci95 or unknown
    level_scatter_low, level_scatter_high = diagnosis.mu_f_scatter95 or unknown
    load_low, load_high = diagnosis.load_level_ci95 or unknown
    return DiagnosisRow(
        id=str(uuid.uuid4()),
        job_id=row.id,
        recording_id=row.recording_id,
        motor=motor,
        current=True,
        created_ns=now_ns,
        recorded_ns=recorded_ns,
        verdict=diagnosis.verdict,
        mu_f=diagnosis.mu_f,
        mu_f_ci95_low=level_low,
        mu_f_ci95_high=level_high,
        mu_f_scatter95_low=level_scatter_low,
        mu_f_scatter95_high=level_scatter_high,
        detection_limit=diagnosis.detection_limit,
        theta_f=diagnosis.theta_f,
        load_level=diagnosis.load_level,
        load_level_ci95_low=load_low,
        load_level_ci95_high=load_high,
        method=diagnosis.method,
        model=diagnosis.model,
        document=document,
        says_nothing=diagnosis.verdict is Verdict.UNDIAGNOSABLE and diagnosis.operation in EXPECTED,
    )


def _document(findings: Findings) -> Mapping[str, object]:
    """Return all that a record shows as a document that every database and reader can hold.

    Raises UnstorableDiagnosisError.
    """
    document = findings.as_dict()
    way = not_finite(document)
    if way is not None:
        raise UnstorableDiagnosisError(f"{way} is not JSON compliant: it is no finite number")
    try:
        text = json.dumps(_with_storable_texts(document), allow_nan=False)
    except (ValueError, TypeError, RecursionError) as error:
        raise UnstorableDiagnosisError(str(error)) from error
    if len(text) > MOST_DOCUMENT_BYTES:
        raise UnstorableDiagnosisError(f"expected at most {MOST_DOCUMENT_BYTES} bytes, found {len(text)}")
    stored: Mapping[str, object] = json.loads(text)
    return stored


def _with_storable_texts(value: object) -> object:
    if isinstance(value, str):
        return storable(value)
    if isinstance(value, Mapping):
        return {key: _with_storable_texts(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_with_storable_texts(one) for one in value]
    return value


def _with_result(recording_id: str) -> Select[JobRow]:
    return select(JobRow).where(JobRow.recording_id == recording_id).options(joinedload(JobRow.result))


def _job_result(row: JobRow) -> JobResult:
    diagnosis = None if row.result is None else record_of(DiagnosisEntry, row.result)
    return JobResult(job(row), diagnosis)


def job(row: JobRow) -> Job:
    return record_of(Job, row)
