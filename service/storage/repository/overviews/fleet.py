"""The overview of all motors, from a few queries however many records they have."""

from collections.abc import Mapping

from sqlalchemy import or_, select
from sqlalchemy.orm import Session, aliased

from service.storage.models import AlarmRow, DiagnosisRow, IedRow, MotorRow
from service.storage.models.alarms import in_state
from service.storage.records import CallingAlarms, FleetMotor, LatestFigures, MotorEntry
from service.storage.repository.conditions.conditions import conditions_of
from service.storage.repository.sessions import Sessions, columns_of
from service.storage.states import AlarmState

CALLING = (AlarmState.UNACKNOWLEDGED, AlarmState.RETURNED_UNACKNOWLEDGED)


class FleetRows(Sessions):
    def fleet(self) -> tuple[FleetMotor, ...]:
        """Return what an overview tells of each motor in service, by name."""
        query = (
            select(*columns_of(MotorEntry, MotorRow), IedRow.link_state, IedRow.link_changed_ns)
            .join(IedRow, IedRow.name == MotorRow.ied)
            .where(MotorRow.in_service)
            .order_by(MotorRow.name)
        )
        with self._read() as session:
            conditions = conditions_of(session)
            figures = {one.motor: one for one in latest_figures_of(session)}
            alarms = _calling(session)
            return tuple(
                FleetMotor(
                    motor=MotorEntry(*entry),
                    condition=conditions[entry[0]],
                    link=link,
                    link_changed_ns=changed_ns,
                    figures=figures.get(entry[0]),
                    alarms=alarms.get(entry[0]),
                )
                for *entry, link, changed_ns in session.execute(query)
                if entry[0] in conditions
            )


def latest_figures_of(session: Session) -> tuple[LatestFigures, ...]:
    """Return the figures of the latest recording of each motor in service that has any, by name."""
    diagnosis = aliased(DiagnosisRow)
    # The index of the trend has all of these columns: no document is read.
    latest = (
        select(diagnosis.id)
        .where(diagnosis.motor == MotorRow.name, diagnosis.current, diagnosis.says_nothing.is_(False))
        .where(diagnosis.mu_f.is_not(None))
        .order_by(diagnosis.recorded_ns.desc(), diagnosis.id.desc())
        .limit(1)
        .scalar_subquery()
    )
    query = (
        select(*columns_of(LatestFigures, DiagnosisRow))
        .select_from(MotorRow)
        .join(DiagnosisRow, DiagnosisRow.id == latest)
        .where(MotorRow.in_service)
        .order_by(MotorRow.name)
    )
    return tuple(LatestFigures(*row) for row in session.execute(query))


def _calling(session: Session) -> Mapping[str, CallingAlarms]:
    """Return the alarms of each motor that call for somebody."""
    query = (
        select(AlarmRow.motor, AlarmRow.urgency, AlarmRow.id, AlarmRow.priority, AlarmRow.raised_ns)
        .where(or_(*map(in_state, CALLING)), AlarmRow.motor.is_not(None))
        .order_by(AlarmRow.urgency, AlarmRow.raised_ns, AlarmRow.id)
    )
    found: dict[str, CallingAlarms] = {}
    for motor, urgency, alarm, priority, raised_ns in session.execute(query):
        if motor is not None:
            number = found[motor].number + 1 if motor in found else 1
            # The last one is the most urgent, and the latest of those.
            found[motor] = CallingAlarms(number, urgency, alarm, priority, raised_ns)
    return found
