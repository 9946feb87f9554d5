"""The recordings that stand for a motor's healthy condition; what they show standing is no fault.

A baseline of a faulty motor hides its fault in all later diagnoses. So a recording is in doubt where anything
says that it is not healthy, and then needs a person who says why it stands for health all the same.
"""

from collections.abc import Sequence

from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from core.condition.events import Event, EventKind
from core.condition.kinds import Kind, State
from core.diagnosis.verdict import Verdict, is_relative
from service.audit.actions import AuditAction
from service.storage.errors import DoubtfulBaselineError, NotFoundError, UnusableBaselineError
from service.storage.models import (
    BaselineRecordingRow,
    BaselineRow,
    DiagnosisRow,
    MotorRow,
    ObservationRow,
    RecordingRow,
)
from service.storage.records import BaselineDoubt, BaselineEntry, RecordingEntry
from service.storage.records.actors import Actor
from service.storage.repository.audit.entries import note_change
from service.storage.repository.conditions.events import keep_event
from service.storage.repository.sessions import Sessions, found, only, record_of
from service.storage.texts import storable

NOT_KNOWN_YET = (
    "the motor's condition at it is not known yet: ask again when the condition follows it, seconds after"
    " its diagnosis"
)


class BaselineRows(Sessions):
    def baseline(self, motor: str) -> BaselineEntry:
        """Return the motor's baseline, without recordings where it has none. Raises NotFoundError."""
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return _entry(session, motor)

    def set_baseline(
        self,
        motor: str,
        recording_ids: Sequence[str],
        *,
        by: Actor,
        reason: str | None = None,
        on_behalf_of: str | None = None,
        now_ns: int,
    ) -> BaselineEntry:
        """Replace the motor's baseline by these recordings.

        It is used for diagnoses that begin from now on. A reason is also kept as a note of the motor, where
        it stays when the baseline is replaced.

        reason: why the recordings stand for health; needed where one is in doubt. on_behalf_of: whom they
        name as who says so.
        Raises NotFoundError (for another motor's recording too), UnusableBaselineError (one that is not
        diagnosed, or was refused), DoubtfulBaselineError.
        """
        chosen = list(dict.fromkeys(recording_ids))
        with self._write() as session:
            found(session, MotorRow, motor, "motor", lock=True)
            causes = {one: _doubt(session, motor, one) for one in chosen}
            doubts = [BaselineDoubt(one, cause) for one, cause in causes.items() if cause is not None]
            if doubts and reason is None:
                raise DoubtfulBaselineError(motor, doubts, len(chosen))
            before = _noted(_entry(session, motor))
            _delete(session, motor)
            session.add(
                BaselineRow(
                    motor=motor,
                    chosen_ns=now_ns,
                    reason=None if reason is None else storable(reason),
                    account=storable(by.name),
                    by=storable(on_behalf_of or by.name),
                )
            )
            session.add_all(
                BaselineRecordingRow(motor=motor, recording_id=one, chosen_ns=now_ns, doubt=cause)
                for one, cause in causes.items()
            )
            if reason is not None:
                note = _note(now_ns, chosen, doubts, reason)
                keep_event(session, motor, note, by, now_ns, on_behalf_of=on_behalf_of)
            session.flush()
            entry = _entry(session, motor)
            subject = ("motor", motor)
            after = _noted(entry)
            action = AuditAction.BASELINE_SET
            note_change(session, by, action, subject, now_ns=now_ns, before=before, after=after)
            return entry

    def delete_baseline(
        self,
        motor: str,
        *,
        by: Actor,
        reason: str | None = None,
        on_behalf_of: str | None = None,
        now_ns: int,
    ) -> None:
        """Delete the motor's baseline, if it has one; its recordings stay.

        A note of the motor keeps when, who did so, and why, where it is said.
        Raises NotFoundError.
        """
        with self._write() as session:
            found(session, MotorRow, motor, "motor", lock=True)
            baseline = _entry(session, motor)
            if baseline.chosen_ns is None:
                return
            _delete(session, motor)
            what = f"baseline of {len(baseline.recordings)} recordings deleted"
            note = what if reason is None else f"{what}: {reason}"
            event = Event(now_ns, EventKind.NOTE, note)
            keep_event(session, motor, event, by, now_ns, on_behalf_of=on_behalf_of)
            note_change(
                session,
                by,
                AuditAction.BASELINE_DELETED,
                ("motor", motor),
                now_ns=now_ns,
                before=_noted(baseline),
                after={"reason": reason, "on_behalf_of": on_behalf_of},
            )


def baseline_rows(session: Session, motor: str) -> Sequence[RecordingRow]:
    """Return the rows of the motor's baseline recordings, oldest first."""
    query = (
        select(RecordingRow)
        .join(BaselineRecordingRow, BaselineRecordingRow.recording_id == RecordingRow.id)
        .where(BaselineRecordingRow.motor == motor)
        .order_by(RecordingRow.recorded_ns, RecordingRow.id)
    )
    return session.scalars(query).all()


def _entry(session: Session, motor: str) -> BaselineEntry:
    row = session.get(BaselineRow, motor)
    if row is None:
        return BaselineEntry()
    doubtful = (
        select(BaselineRecordingRow)
        .where(BaselineRecordingRow.motor == motor, BaselineRecordingRow.doubt.is_not(None))
        .order_by(BaselineRecordingRow.recording_id)
    )
    return BaselineEntry(
        recordings=tuple(record_of(RecordingEntry, one) for one in baseline_rows(session, motor)),
        chosen_ns=row.chosen_ns,
        reason=row.reason,
        account=row.account,
        by=row.by,
        doubts=tuple(record_of(BaselineDoubt, one) for one in session.scalars(doubtful)),
    )


def _noted(baseline: BaselineEntry) -> dict[str, object] | None:
    """Return what the audit trail keeps of a baseline; None where there is none."""
    if baseline.chosen_ns is None:
        return None
    ids = [recording.id for recording in baseline.recordings]
    return {"recordings": ids, "reason": baseline.reason, "on_behalf_of": baseline.on_behalf_of}


def _delete(session: Session, motor: str) -> None:
    session.execute(delete(BaselineRecordingRow).where(BaselineRecordingRow.motor == motor))
    session.execute(delete(BaselineRow).where(BaselineRow.motor == motor))


def _doubt(session: Session, motor: str, recording_id: str) -> str | None:
    """Return what speaks against a recording as one of a healthy motor; None where nothing does.

    Raises NotFoundError, UnusableBaselineError.
    """
    recording = session.get(RecordingRow, recording_id)
    if recording is None or recording.motor != motor:
        raise NotFoundError(f"recording of motor {motor}", recording_id)
    query = select(DiagnosisRow).where(DiagnosisRow.recording_id == recording_id, DiagnosisRow.current)
    diagnosis = only(session, query)
    if diagnosis is None:
        raise UnusableBaselineError(recording_id, f"it is {recording.state}, not diagnosed")
    if recording.copy_of is not None:
        raise UnusableBaselineError(recording_id, f"it is a copy: take recording {recording.copy_of}")
    if diagnosis.verdict is Verdict.UNDIAGNOSABLE:
        raise UnusableBaselineError(recording_id, "the diagnosis refused it")
    return _doubt_of_verdict(diagnosis) or _doubt_of_condition(session, recording_id)


def _doubt_of_verdict(diagnosis: DiagnosisRow) -> str | None:
    if diagnosis.verdict is not Verdict.HEALTHY:
        phase = "" if diagnosis.theta_f is None else f", phase {'abc'[diagnosis.theta_f]}"
        level = "" if diagnosis.mu_f is None else f": {diagnosis.mu_f:.2%} of the turns{phase}"
        return f"its verdict is {diagnosis.verdict}{level}"
    reasons = diagnosis.document.get("reasons")
    if isinstance(reasons, list) and is_relative(map(str, reasons)):
        return "its verdict is healthy only relative to the baseline of that time"
    return None


def _doubt_of_condition(session: Session, recording_id: str) -> str | None:
    """Shorted turns that only the records in a row show, or that nothing tells from something else.

    Right after a diagnosis nobody knows; a recording that tells nothing of the condition is in no doubt.
    """
    observation = session.get(ObservationRow, recording_id)
    if observation is None:
        return None
    if observation.state is None:
        return NOT_KNOWN_YET
    if observation.state is State.FAULT or (
        observation.state is State.WATCH and observation.kind in (Kind.SHORTED_TURNS, Kind.UNCLEAR)
    ):
        return f"the motor's condition was {observation.state} ({observation.kind}) at it"
    return None


def _note(now_ns: int, chosen: Sequence[str], doubts: Sequence[BaselineDoubt], reason: str) -> Event:
    what = f"baseline of {len(chosen)} recordings, {len(doubts)} of them in doubt"
    return Event(now_ns, EventKind.NOTE, f"{what}: {reason}")
