"""The recordings that stand for a motor's healthy condition; what they show standing is no fault."""

from collections.abc import Sequence

from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from core.diagnosis.verdict import Verdict
from service.storage.errors import NotFoundError, UnusableBaselineError
from service.storage.models import BaselineRecordingRow, DiagnosisRow, MotorRow, RecordingRow
from service.storage.records import RecordingEntry
from service.storage.repository.sessions import Sessions, found, only, record_of


class BaselineRows(Sessions):
    def baseline(self, motor: str) -> tuple[RecordingEntry, ...]:
        """Return the motor's baseline recordings, oldest first, if there are any. Raises NotFoundError."""
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return tuple(record_of(RecordingEntry, row) for row in baseline_rows(session, motor))

    def set_baseline(
        self, motor: str, recording_ids: Sequence[str], *, now_ns: int
    ) -> tuple[RecordingEntry, ...]:
        """Replace the motor's baseline by these recordings; without any, the motor has no baseline.

        It is used for diagnoses that begin from now on. Raises NotFoundError (for another motor's recording
        too), UnusableBaselineError (one that is not diagnosed, or was refused).
        """
        with self._write() as session:
            found(session, MotorRow, motor, "motor", lock=True)
            for recording_id in recording_ids:
                _check(session, motor, recording_id)
            session.execute(delete(BaselineRecordingRow).where(BaselineRecordingRow.motor == motor))
            session.add_all(
                BaselineRecordingRow(motor=motor, recording_id=recording_id, chosen_ns=now_ns)
                for recording_id in dict.fromkeys(recording_ids)
            )
            session.flush()
            return tuple(record_of(RecordingEntry, row) for row in baseline_rows(session, motor))


def baseline_rows(session: Session, motor: str) -> Sequence[RecordingRow]:
    """Return the rows of the motor's baseline recordings, oldest first."""
    query = (
        select(RecordingRow)
        .join(BaselineRecordingRow, BaselineRecordingRow.recording_id == RecordingRow.id)
        .where(BaselineRecordingRow.motor == motor)
        .order_by(RecordingRow.recorded_ns, RecordingRow.id)
    )
    return session.scalars(query).all()


def _check(session: Session, motor: str, recording_id: str) -> None:
    recording = session.get(RecordingRow, recording_id)
    if recording is None or recording.motor != motor:
        raise NotFoundError(f"recording of motor {motor}", recording_id)
    query = select(DiagnosisRow).where(DiagnosisRow.recording_id == recording_id, DiagnosisRow.current)
    diagnosis = only(session, query)
    if diagnosis is None:
        raise UnusableBaselineError(recording_id, f"it is {recording.state}, not diagnosed")
    if diagnosis.verdict is Verdict.UNDIAGNOSABLE:
        raise UnusableBaselineError(recording_id, "the diagnosis refused it")
