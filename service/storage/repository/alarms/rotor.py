"""The alarm of a motor's rotor: it follows the condition that all records of the motor tell together."""

from collections.abc import Sequence
from typing import Final

from sqlalchemy import exists, or_, select
from sqlalchemy.orm import Session, aliased

from core.rotor.advice import rotor_advice
from core.rotor.trend import RotorCondition
from service.alarms.kinds import ROTOR_KINDS as KINDS
from service.storage.models import AlarmRow, MotorRow, RotorFindingRow
from service.storage.models.alarms import is_open
from service.storage.records import AlarmPlace, AlarmSpec
from service.storage.repository.alarms.causes import (
    LEFT_THE_PLANT,
    end_of_motor,
    forget_cleared,
    locked_place,
    raised_at,
    supersede,
)
from service.storage.repository.alarms.changes import locked
from service.storage.repository.history.rotor import latest_findings
from service.storage.repository.history.rotor_course import course_condition, latest_condition
from service.storage.repository.sessions import Sessions, found
from service.storage.states import AlarmState

SUBJECT: Final = "rotor"
OF_ROTOR: Final = tuple(KINDS.values())


class RotorAlarmRows(Sessions):
    def settle_rotor_alarm(self, motor: str, *, now_ns: int) -> None:
        """Make the alarm of a motor's rotor say what its records say. Raises NotFoundError."""
        of_rotor = (AlarmRow.motor == motor, is_open(), AlarmRow.kind.in_(OF_ROTOR))
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            is_quiet = latest_condition(session, motor) not in KINDS
            if is_quiet and session.scalar(select(AlarmRow.id).where(*of_rotor).limit(1)) is None:
                return
        with self._write() as session:
            place = locked_place(session, AlarmPlace(motor=motor))
            in_service = found(session, MotorRow, motor, "motor").in_service
            rows = locked(session, *of_rotor)
            condition = course_condition(session, motor)
            if in_service and condition.state in KINDS:
                _tell(session, place, rows, condition, now_ns)
                return
            why = "; ".join(condition.reasons) if in_service else LEFT_THE_PLANT
            end_of_motor(session, motor, rows, why, now_ns=now_ns)

    def settle_rotor_alarms(self, *, now_ns: int) -> None:
        """Make the alarms of all rotors say what the records say, as a service does when it starts.

        Of motors with such an alarm, or whose latest record shows that somebody has to look after the rotor.
        """
        alarm, finding = aliased(AlarmRow), aliased(RotorFindingRow)
        latest = (
            select(finding.state)
            .where(finding.motor == MotorRow.name)
            .order_by(finding.time_ns.desc(), finding.recording_id.desc())
            .limit(1)
            .scalar_subquery()
        )
        stands = exists().where(
            alarm.motor == MotorRow.name, alarm.kind.in_(OF_ROTOR), alarm.cleared_ns.is_(None)
        )
        query = select(MotorRow.name).where(or_(stands, latest.in_(tuple(KINDS)))).order_by(MotorRow.name)
        with self._read() as session:
            motors = session.scalars(query).all()
        for motor in motors:
            self.settle_rotor_alarm(motor, now_ns=now_ns)


def _tell(
    session: Session,
    place: AlarmPlace,
    rows: Sequence[AlarmRow],
    condition: RotorCondition,
    now_ns: int,
) -> None:
    """Have the alarm of this state stand with the present words, in place of the one of another state."""
    latest = next(iter(latest_findings(session, place.motor or "", 1)), None)
    spec = AlarmSpec(
        KINDS[condition.state],
        reason=_reason(condition),
        subject=SUBJECT,
        one_of_kind=True,
        advice=rotor_advice(condition.state),
        recording_id=latest.recording_id if latest is not None else None,
    )
    row = raised_at(session, place, spec, now_ns=now_ns)
    others = [
        other
        for other in rows
        if other is not row
        and (other.cleared_ns is None or other.state is AlarmState.RETURNED_UNACKNOWLEDGED)
    ]
    for other in others:
        supersede(session, other, row, now_ns=now_ns)
    if others:
        forget_cleared(session, AlarmRow.motor == row.motor)


def _reason(condition: RotorCondition) -> str:
    severity_dB, change_dB = condition.severity_dB, condition.change_dB
    told = [] if severity_dB is None else [f"rotor bar severity {severity_dB:.1f} dB"]
    if change_dB is not None:
        told.append(f"{change_dB:+.1f} dB against the baseline of its load")
    return "; ".join([*told, *condition.reasons])
