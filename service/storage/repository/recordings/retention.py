"""What is older than somebody wants to keep it: how much there is, and deleting some of it."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from time import monotonic
from typing import Any

from sqlalchemy import ColumnElement, and_, case, delete, exists, func, select
from sqlalchemy.orm import InstrumentedAttribute, Session

from core.diagnosis.verdict import Verdict
from service.audit.actions import AuditAction
from service.storage.models import (
    DeletedRemoteRecordRow,
    DeletionRow,
    DiagnosisRow,
    JobRow,
    MeasurementRow,
    MotorRow,
    RecordingRequestRow,
    RecordingRow,
)
from service.storage.records import Amount, AppliedRule, DeletedRows, OldRecording
from service.storage.repository.audit.entries import note_change
from service.storage.repository.recordings.deletions import delete_row, to_delete
from service.storage.repository.recordings.kept_recordings import Keeping, conditions
from service.storage.repository.recordings.requests import ENDED
from service.storage.repository.sessions import Sessions
from service.storage.states import DeletedBy, JobState, RecordingState, StayReason

NOTHING = Amount(0, 0, None, None)


@dataclass(frozen=True, slots=True)
class ExpiredRecordings:
    """Recordings in a state, with a verdict, that were first seen before a time.

    verdict: None for recordings of any verdict or none.  keeping: what of them stays all the same.
    says_nothing: whether the motor stands, starts, stops or trips in them.
    """

    state: RecordingState
    verdict: Verdict | None
    before_ns: int
    keeping: Keeping
    says_nothing: bool = False


class RetentionRows(Sessions):
    def all_motors(self) -> tuple[str, ...]:
        """Return the names of all motors, also of those that left the plant."""
        with self._read() as session:
            return tuple(session.scalars(select(MotorRow.name).order_by(MotorRow.name)))

    def expired_recordings(self, expired: ExpiredRecordings) -> Amount:
        """Return how many recordings could be deleted, with the size of their files."""
        amount = NOTHING
        for motor in self.all_motors():
            with self._read() as session:
                condition = _expired(session, motor, expired)
                size = func.sum(RecordingRow.size_bytes)
                amount = amount.plus(_amount(session, RecordingRow.announced_ns, condition, size))
        return amount

    def old_recordings(self, motor: str, expired: ExpiredRecordings) -> tuple[OldRecording, ...]:
        """Return the recordings of a motor that a rule is for, oldest first, also those that stay."""
        columns = [getattr(RecordingRow, field.name) for field in fields(OldRecording)[:-1]]
        with self._read() as session:
            kept = conditions(session, motor, expired.keeping)
            why = case(*((condition, reason.value) for reason, condition in kept.items()), else_=None)
            query = select(*columns, why.label("stays")).where(_old(motor, expired))
            rows = session.execute(query.order_by(RecordingRow.announced_ns, RecordingRow.id)).all()
        return tuple(map(_old_recording, rows))

    def forget_recordings(
        self,
        motor: str,
        rows: int,
        *,
        expired: ExpiredRecordings,
        reason: str,
        now_ns: int,
        rule: AppliedRule | None = None,
    ) -> DeletedRows:
        """Delete the oldest of a motor's expired recordings, at most so many, as one deletes one by hand.

        Each is looked at again once nobody else can change it: it may have another verdict by then, or have
        become one of the newest. rule: what the audit trail keeps of it; None: nothing.
        """
        while ids := self._oldest_expired(motor, expired, rows):
            deleted = self._delete_expired(motor, ids, expired, reason, now_ns, rule)
            if deleted.rows:
                return deleted
        return DeletedRows(0, 0.0)

    def _oldest_expired(self, motor: str, expired: ExpiredRecordings, rows: int) -> Sequence[str]:
        with self._read() as session:
            condition = _expired(session, motor, expired)
            order = (RecordingRow.announced_ns, RecordingRow.id)
            return session.scalars(
                select(RecordingRow.id).where(condition).order_by(*order).limit(rows)
            ).all()

    def _delete_expired(
        self,
        motor: str,
        ids: Sequence[str],
        expired: ExpiredRecordings,
        reason: str,
        now_ns: int,
        rule: AppliedRule | None,
    ) -> DeletedRows:
        deleted = []
        with self._write() as session:
            session.connection()
            began_s = monotonic()
            locked = [to_delete(session, motor, recording_id) for recording_id in ids]
            # Nobody else can change them now, and to delete one makes none of the others stay or go.
            still = _expired(session, motor, expired)
            expired_ids = set(session.scalars(select(RecordingRow.id).where(still, RecordingRow.id.in_(ids))))
            for row in locked:
                if row is not None and row.id in expired_ids:
                    delete_row(session, row, reason, DeletedBy.RETENTION, now_ns)
                    deleted.append(row.id)
            _note(session, rule, len(deleted), motor=motor, recordings=deleted)
        return DeletedRows(len(deleted), monotonic() - began_s)

    def old_measurements(self, step_s: int, *, before_ns: int) -> Amount:
        with self._read() as session:
            condition = and_(MeasurementRow.step_s == step_s, MeasurementRow.time_ns < before_ns)
            return _amount(session, MeasurementRow.time_ns, condition)

    def superseded_diagnoses(self, *, before_ns: int) -> Amount:
        """Return how many results there are that a later diagnosis of the same recording replaced."""
        with self._read() as session:
            return _amount(session, DiagnosisRow.created_ns, _superseded(before_ns))

    def forget_superseded_diagnoses(
        self, rows: int, *, before_ns: int, rule: AppliedRule | None = None
    ) -> DeletedRows:
        """Delete some of them, each with its job."""
        old = select(DiagnosisRow.id, DiagnosisRow.job_id).where(_superseded(before_ns)).limit(rows)
        with self._write() as session:
            session.connection()
            began_s = monotonic()
            found = session.execute(old).all()
            session.execute(delete(DiagnosisRow).where(DiagnosisRow.id.in_([row.id for row in found])))
            _delete_jobs(session, JobRow.id.in_([row.job_id for row in found]))
            _note(session, rule, len(found))
        return DeletedRows(len(found), monotonic() - began_s)

    def failed_jobs(self, *, before_ns: int) -> Amount:
        with self._read() as session:
            return _amount(session, JobRow.finished_ns, _failed(before_ns))

    def forget_failed_jobs(
        self, rows: int, *, before_ns: int, rule: AppliedRule | None = None
    ) -> DeletedRows:
        """Delete some of the jobs that were given up; their recordings keep the reason."""
        with self._write() as session:
            session.connection()
            began_s = monotonic()
            ids = session.scalars(select(JobRow.id).where(_failed(before_ns)).limit(rows)).all()
            _delete_jobs(session, JobRow.id.in_(ids))
            _note(session, rule, len(ids))
        return DeletedRows(len(ids), monotonic() - began_s)

    def ended_requests(self, *, before_ns: int) -> Amount:
        with self._read() as session:
            return _amount(session, RecordingRequestRow.requested_ns, _ended(before_ns))

    def forget_ended_requests(
        self, rows: int, *, before_ns: int, rule: AppliedRule | None = None
    ) -> DeletedRows:
        """Delete the oldest recording requests that have ended, at most so many."""
        old = (
            select(RecordingRequestRow)
            .where(_ended(before_ns))
            .order_by(RecordingRequestRow.requested_ns, RecordingRequestRow.id)
            .limit(rows)
        )
        with self._write() as session:
            session.connection()
            began_s = monotonic()
            found = session.scalars(old).all()
            for row in found:
                session.delete(row)
            _note(session, rule, len(found))
        return DeletedRows(len(found), monotonic() - began_s)

    def old_deletions(self, *, before_ns: int) -> Amount:
        with self._read() as session:
            return _amount(session, DeletionRow.deleted_ns, DeletionRow.deleted_ns < before_ns)

    def forget_deletions(self, rows: int, *, before_ns: int, rule: AppliedRule | None = None) -> DeletedRows:
        """Forget some of what was deleted long ago; a relay that still lists it is asked for it again."""
        old = select(DeletionRow.id).where(DeletionRow.deleted_ns < before_ns)
        with self._write() as session:
            session.connection()
            began_s = monotonic()
            ids = session.scalars(old.order_by(DeletionRow.deleted_ns, DeletionRow.id).limit(rows)).all()
            of_these = DeletedRemoteRecordRow.deletion_id.in_(ids)
            session.execute(delete(DeletedRemoteRecordRow).where(of_these))
            session.execute(delete(DeletionRow).where(DeletionRow.id.in_(ids)))
            _note(session, rule, len(ids))
        return DeletedRows(len(ids), monotonic() - began_s)


def _note(session: Session, rule: AppliedRule | None, number: int, **more: object) -> None:
    """Tell the audit trail what a rule deleted, if that is anything."""
    if rule is not None and number:
        action, subject = AuditAction.RETENTION_APPLIED, ("rule", rule.setting)
        note_change(session, rule.by, action, subject, now_ns=rule.now_ns, before={"deleted": number, **more})


def _amount(
    session: Session,
    time_ns: InstrumentedAttribute[int] | InstrumentedAttribute[int | None],
    condition: ColumnElement[bool],
    size_bytes: ColumnElement[int] | None = None,
) -> Amount:
    query = select(func.count(), func.min(time_ns), func.max(time_ns)).where(condition)
    if size_bytes is not None:
        query = query.add_columns(size_bytes)
    row: Sequence[int | None] = session.execute(query).one()
    number, oldest_ns, newest_ns, *size = row
    return Amount(int(number or 0), int(size[0] or 0) if size else 0, oldest_ns, newest_ns)


def _old_recording(row: Any) -> OldRecording:
    """Return the recording of a row that has the columns of one, and why it stays."""
    values = {field.name: getattr(row, field.name) for field in fields(OldRecording)}
    reason = values.pop("stays")
    return OldRecording(**values, stays=None if reason is None else StayReason(reason))


def _expired(session: Session, motor: str, expired: ExpiredRecordings) -> ColumnElement[bool]:
    """Return the condition that a recording of the motor is deleted."""
    kept = conditions(session, motor, expired.keeping)
    return and_(_old(motor, expired), *(~condition for condition in kept.values()))


def _old(motor: str, expired: ExpiredRecordings) -> ColumnElement[bool]:
    """Return the condition that the rule is for a recording of the motor, which may stay all the same."""
    matching = [
        RecordingRow.motor == motor,
        RecordingRow.state == expired.state,
        RecordingRow.announced_ns < expired.before_ns,
    ]
    if expired.verdict is not None:
        matching.append(
            exists().where(
                DiagnosisRow.recording_id == RecordingRow.id,
                DiagnosisRow.current,
                DiagnosisRow.verdict == expired.verdict,
                DiagnosisRow.says_nothing.is_(expired.says_nothing),
            )
        )
    return and_(*matching)


def _superseded(before_ns: int) -> ColumnElement[bool]:
    # By motor, which the index begins with: the current ones are not read.
    return and_(
        DiagnosisRow.motor.in_(select(MotorRow.name)),
        DiagnosisRow.current.is_(False),
        DiagnosisRow.created_ns < before_ns,
    )


def _failed(before_ns: int) -> ColumnElement[bool]:
    return and_(JobRow.state == JobState.FAILED, JobRow.finished_ns < before_ns)


def _ended(before_ns: int) -> ColumnElement[bool]:
    return and_(RecordingRequestRow.requested_ns < before_ns, RecordingRequestRow.state.in_(ENDED))


def _delete_jobs(session: Session, condition: ColumnElement[bool]) -> None:
    """Delete jobs one by one, as objects: the session counts them by their states."""
    for job in session.scalars(select(JobRow).where(condition)):
        session.delete(job)
