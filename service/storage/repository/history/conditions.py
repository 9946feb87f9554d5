"""What was said of motors at a time in the past, and what changed in a time."""

from collections.abc import Mapping
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import aliased

from service.storage.models import ConditionChangeRow, MotorRow, ObservationRow
from service.storage.records import ConditionChange, ConditionPoint
from service.storage.repository.conditions.observations import point
from service.storage.repository.sessions import Sessions, columns_of


class PastConditionRows(Sessions):
    def conditions_at(self, time_ns: int) -> Mapping[str, ConditionPoint]:
        """Return what was said of each motor in service from its latest record until then on, by name.

        A motor without any record until then is not there.
        """
        observation = aliased(ObservationRow)
        # One look into the index of each motor's records, however many there are.
        latest = (
            select(observation.recording_id)
            .where(
                observation.motor == MotorRow.name,
                observation.time_ns <= time_ns,
                observation.state.is_not(None),
            )
            .order_by(observation.time_ns.desc(), observation.recording_id.desc())
            .limit(1)
            .scalar_subquery()
        )
        query = (
            select(MotorRow.name, *columns_of(ConditionPoint, ObservationRow))
            .select_from(MotorRow)
            .join(ObservationRow, ObservationRow.recording_id == latest)
            .where(MotorRow.in_service)
            .order_by(MotorRow.name)
        )
        with self._read() as session:
            return {motor: point(*values) for motor, *values in session.execute(query)}

    def condition_changes_between(
        self, from_ns: int, to_ns: int, *, limit: int
    ) -> tuple[ConditionChange, ...]:
        """Return the latest changes of motors in service, from_ns < time <= to_ns, oldest first."""
        in_service = select(MotorRow.name).where(MotorRow.in_service)
        query = (
            select(*columns_of(ConditionChange, ConditionChangeRow))
            .where(
                ConditionChangeRow.motor.in_(in_service),
                ConditionChangeRow.time_ns > from_ns,
                ConditionChangeRow.time_ns <= to_ns,
            )
            .order_by(ConditionChangeRow.time_ns.desc(), ConditionChangeRow.id.desc())
            .limit(limit)
        )
        with self._read() as session:
            rows = session.execute(query).all()
        return tuple(_change(*row) for row in reversed(rows))


def _change(*values: Any) -> ConditionChange:
    return ConditionChange(**dict(zip(ConditionChange.__dataclass_fields__, values, strict=True)))
