"""What is known of motors: the latest diagnosis, the relay, and the trend."""

from collections.abc import Sequence

from sqlalchemy import Select, func, or_, select
from sqlalchemy.orm import Session, aliased

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
from service.storage.repository.sessions import Order, Sessions, found, page_of, record_of
from service.storage.states import RecordingState


class MotorHealthRows(Sessions):
    def health(self, motor: str) -> MotorHealth:
        """Return what is known of a motor now. Raises NotFoundError.

        The latest recording counts, not the latest diagnosis made.
        """
        with self._read() as session:
            (health,) = _health_of(session, [found(session, MotorRow, motor, "motor")])
            return health

    def health_of_motors(self, *, limit: int, after: Cursor | None = None) -> Page[MotorHealth]:
        """Return what is known of the motors in service, by name."""
        query = select(MotorRow).where(MotorRow.in_service)
        with self._read() as session:
            rows = page_of(session, query, [MotorRow.name], lambda row: row, limit=limit, after=after)
            return Page(_health_of(session, rows.items), rows.next)

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
        """Return a figure of each recording, oldest first, from_ns <= time < to_ns. Raises NotFoundError."""
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


def _health_of(session: Session, motors: Sequence[MotorRow]) -> tuple[MotorHealth, ...]:
    """Return the condition of each motor from a few queries, however many motors there are.

    An index finds each motor's latest rows.
    """
    names = [motor.name for motor in motors]
    diagnosis = aliased(DiagnosisRow)
    latest_diagnosis = (
        select(diagnosis.id)
        .where(diagnosis.motor == MotorRow.name, diagnosis.current)
        .order_by(diagnosis.recorded_ns.desc(), diagnosis.id.desc())
        .limit(1)
    )
    diagnoses = {
        row.motor: record_of(DiagnosisEntry, row)
        for row in session.scalars(
            select(DiagnosisRow).where(DiagnosisRow.id.in_(_for_each(names, latest_diagnosis)))
        )
    }
    recordings = _latest_recordings(session, names)
    relays = {
        row.name: record_of(IedEntry, row)
        for row in session.scalars(select(IedRow).where(IedRow.name.in_({motor.ied for motor in motors})))
    }
    return tuple(
        MotorHealth(
            motor=record_of(MotorEntry, motor),
            ied=relays[motor.ied],
            diagnosis=diagnoses.get(motor.name),
            last_recording=recordings.get(motor.name),
        )
        for motor in motors
    )


def _latest_recordings(session: Session, motors: Sequence[str]) -> dict[str, RecordingEntry]:
    """Return each motor's latest recording: by its own time, or when it was first seen while that is unknown.

    A record of last year that is uploaded today is not the latest. Each of the two has an index.
    """
    recording = aliased(RecordingRow)
    of_motor = select(recording.id).where(
        recording.motor == MotorRow.name, recording.state != RecordingState.ANNOUNCED
    )
    timed = (
        of_motor.where(recording.recorded_ns.is_not(None))
        .order_by(recording.recorded_ns.desc(), recording.id.desc())
        .limit(1)
    )
    untimed = (
        of_motor.where(recording.recorded_ns.is_(None))
        .order_by(recording.announced_ns.desc(), recording.id.desc())
        .limit(1)
    )
    time_ns = func.coalesce(RecordingRow.recorded_ns, RecordingRow.announced_ns)
    latest = (
        select(RecordingRow)
        .where(or_(*(RecordingRow.id.in_(_for_each(motors, one)) for one in (timed, untimed))))
        .order_by(time_ns, RecordingRow.id)
    )
    return {row.motor: record_of(RecordingEntry, row) for row in session.scalars(latest)}


def _for_each(motors: Sequence[str], latest: Select[str]) -> Select[str]:
    """Return one id for each of the motors: what `latest` finds for it."""
    return select(latest.scalar_subquery()).select_from(MotorRow).where(MotorRow.name.in_(motors))


def _trend_point(row: DiagnosisRow, quantity: Quantity) -> TrendPoint:
    ci95 = None
    if quantity == "mu_f" and row.mu_f_ci95_low is not None and row.mu_f_ci95_high is not None:
        ci95 = (row.mu_f_ci95_low, row.mu_f_ci95_high)
    value = {"mu_f": row.mu_f, "theta_f": row.theta_f, "load_level": row.load_level}[quantity]
    return TrendPoint(row.recorded_ns, value, ci95, row.verdict, row.recording_id)
