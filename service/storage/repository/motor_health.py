"""What is known of motors now: the condition, the latest diagnosis, the relay."""

from collections.abc import Sequence
from typing import Any

from sqlalchemy import (
    BindParameter,
    ColumnElement,
    Select,
    and_,
    bindparam,
    func,
    select,
    union_all,
)
from sqlalchemy.orm import Session, aliased

from core.operation import Operation
from service.storage.models import (
    DiagnosisRow,
    IedRow,
    MotorRow,
    RecordingRow,
)
from service.storage.records import (
    Cursor,
    IedEntry,
    LatestDiagnosis,
    LatestFigures,
    MotorEntry,
    MotorHealth,
    Page,
    RecordedStarts,
    RecordingEntry,
)
from service.storage.repository.conditions.conditions import conditions_of
from service.storage.repository.overviews.fleet import latest_figures_of
from service.storage.repository.sessions import Sessions, columns_of, found, page_of, record_of
from service.storage.states import RecordingState

_LEVEL = (
    DiagnosisRow.mu_f,
    DiagnosisRow.mu_f_ci95_low,
    DiagnosisRow.mu_f_ci95_high,
    DiagnosisRow.mu_f_scatter95_low,
    DiagnosisRow.mu_f_scatter95_high,
    DiagnosisRow.detection_limit,
)
_LOAD = (DiagnosisRow.load_level, DiagnosisRow.load_level_ci95_low, DiagnosisRow.load_level_ci95_high)
_SAID = (
    DiagnosisRow.motor,
    DiagnosisRow.recording_id,
    DiagnosisRow.recorded_ns,
    DiagnosisRow.verdict,
    *_LEVEL,
    DiagnosisRow.theta_f,
    *_LOAD,
    DiagnosisRow.document["reasons"],
)
"""The columns of a LatestDiagnosis. The database takes the reasons from the document, which is long."""


class MotorHealthRows(Sessions):
    def health(self, motor: str) -> MotorHealth:
        """Return what is known of a motor now. Raises NotFoundError.

        The latest recording counts, not the latest diagnosis made.
        """
        with self._read() as session:
            entry = record_of(MotorEntry, found(session, MotorRow, motor, "motor"))
            (health,) = _health_of(session, [entry])
            return health

    def health_of_motors(self, *, limit: int, after: Cursor | None = None) -> Page[MotorHealth]:
        """Return what is known of the motors in service, by name."""
        query = select(*columns_of(MotorEntry, MotorRow)).where(MotorRow.in_service)
        with self._read() as session:
            motors = page_of(session, query, [MotorRow.name], MotorEntry, limit=limit, after=after)
            return Page(_health_of(session, motors.items), motors.next)

    def latest_figures(self) -> tuple[LatestFigures, ...]:
        """Return the figures of the latest recording of each motor in service that has any, by name."""
        with self._read() as session:
            return latest_figures_of(session)


def _health_of(session: Session, motors: Sequence[MotorEntry]) -> tuple[MotorHealth, ...]:
    """Return the condition of each motor from a few queries, however many motors there are.

    An index finds each motor's latest rows.
    """
    named = {"of_motors": [motor.name for motor in motors]}
    diagnoses = {row.motor: LatestDiagnosis(*row) for row in session.execute(_LATEST_DIAGNOSES, named)}
    recordings = {row.motor: RecordingEntry(*row) for row in session.execute(_LATEST_RECORDINGS, named)}
    starts = {row.motor: RecordedStarts(*row[1:]) for row in session.execute(_USABLE_STARTS, named)}
    conditions = conditions_of(session, named["of_motors"])
    links = session.execute(_RELAYS, {"of_relays": list({motor.ied for motor in motors})})
    relays = {row.name: IedEntry(*row) for row in links}
    return tuple(
        MotorHealth(
            motor=motor,
            ied=relays[motor.ied],
            condition=conditions[motor.name],
            diagnosis=diagnoses.get(motor.name),
            last_recording=recordings.get(motor.name),
            starts=starts.get(motor.name),
        )
        for motor in motors
    )


def is_usable_start() -> ColumnElement[bool]:
    """Return the condition that the parameters of a motor can be estimated from a recording."""
    return and_(
        RecordingRow.operation == Operation.START,
        RecordingRow.operation_remark.is_(None),
        RecordingRow.copy_of.is_(None),
    )


_OF_MOTORS: BindParameter[str] = bindparam("of_motors", expanding=True)


def _for_each_motor(latest: Select[str]) -> Select[str]:
    """Return one id for each of the motors: what `latest` finds for it."""
    return select(latest.scalar_subquery()).select_from(MotorRow).where(MotorRow.name.in_(_OF_MOTORS))


def _latest_diagnoses() -> Select[Any]:
    diagnosis = aliased(DiagnosisRow)
    latest = (
        select(diagnosis.id)
        .where(diagnosis.motor == MotorRow.name, diagnosis.current, diagnosis.says_nothing.is_(False))
        .order_by(diagnosis.recorded_ns.desc(), diagnosis.id.desc())
        .limit(1)
    )
    return select(*_SAID).where(DiagnosisRow.id.in_(_for_each_motor(latest)))


_RECORDED_NS = func.coalesce(RecordingRow.recorded_ns, RecordingRow.announced_ns)


def _latest_recordings() -> Select[Any]:
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
    latest = union_all(*(_for_each_motor(one) for one in (timed, untimed)))
    return (
        select(*columns_of(RecordingEntry, RecordingRow))
        .where(RecordingRow.id.in_(latest))
        .order_by(_RECORDED_NS, RecordingRow.id)
    )


# Built once: that takes a sixth of the time of an answer of a hundred motors.
_LATEST_DIAGNOSES = _latest_diagnoses()
_LATEST_RECORDINGS = _latest_recordings()
_USABLE_STARTS = (
    select(RecordingRow.motor, func.count(), func.max(_RECORDED_NS))
    .where(RecordingRow.motor.in_(_OF_MOTORS), is_usable_start())
    .group_by(RecordingRow.motor)
)
_RELAYS = select(*columns_of(IedEntry, IedRow)).where(IedRow.name.in_(bindparam("of_relays", expanding=True)))
