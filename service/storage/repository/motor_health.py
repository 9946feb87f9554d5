"""What is known of motors: the latest diagnosis, the relay, and the trend."""

from sqlalchemy import select

from service.storage.models import (
    DiagnosisRow,
    IedRow,
    MotorRow,
    RecordingRow,
)
from service.storage.records import (
    Cursor,
    DiagnosisEntry,
    IedEntry,
    MotorEntry,
    MotorHealth,
    Page,
    Quantity,
    RecordingEntry,
    TrendPoint,
)
from service.storage.repository.sessions import Order, Sessions, found, only, page_of, record_of
from service.storage.states import RecordingState


class MotorHealthRows(Sessions):
    def health(self, motor: str) -> MotorHealth:
        """What is known of a motor now; the latest recording counts, not the latest diagnosis made.

        Raises NotFoundError.
        """
        of_motor = select(DiagnosisRow).where(DiagnosisRow.motor == motor, DiagnosisRow.current)
        latest = of_motor.order_by(DiagnosisRow.recorded_ns.desc(), DiagnosisRow.id.desc())
        recordings = (
            select(RecordingRow)
            .where(RecordingRow.motor == motor, RecordingRow.state != RecordingState.ANNOUNCED)
            .order_by(RecordingRow.announced_ns.desc(), RecordingRow.id.desc())
        )
        with self._read() as session:
            row = found(session, MotorRow, motor, "motor")
            diagnosis = only(session, latest)
            recording = only(session, recordings)
            return MotorHealth(
                motor=record_of(MotorEntry, row),
                ied=record_of(IedEntry, found(session, IedRow, row.ied, "IED")),
                diagnosis=None if diagnosis is None else record_of(DiagnosisEntry, diagnosis),
                last_recording=None if recording is None else record_of(RecordingEntry, recording),
            )

    def trend(
        self,
        motor: str,
        quantity: Quantity,
        *,
        limit: int,
        from_ns: int | None = None,
        to_ns: int | None = None,
        after: Cursor | None = None,
    ) -> Page[TrendPoint]:
        """One point a recording, oldest first, from_ns <= time < to_ns. Raises NotFoundError."""
        query = select(DiagnosisRow).where(DiagnosisRow.motor == motor, DiagnosisRow.current)
        if from_ns is not None:
            query = query.where(DiagnosisRow.recorded_ns >= from_ns)
        if to_ns is not None:
            query = query.where(DiagnosisRow.recorded_ns < to_ns)
        order: Order = [DiagnosisRow.recorded_ns, DiagnosisRow.id]
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return page_of(
                session, query, order, lambda row: _trend_point(row, quantity), limit=limit, after=after
            )


def _trend_point(row: DiagnosisRow, quantity: Quantity) -> TrendPoint:
    ci95 = None
    if quantity == "mu_f" and row.mu_f_ci95_low is not None and row.mu_f_ci95_high is not None:
        ci95 = (row.mu_f_ci95_low, row.mu_f_ci95_high)
    value = {"mu_f": row.mu_f, "theta_f": row.theta_f, "load_level": row.load_level}[quantity]
    return TrendPoint(row.recorded_ns, value, ci95, row.verdict, row.recording_id)
