"""What has happened since somebody last asked, for readers that keep their own place."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import fields

from sqlalchemy import func, select
from sqlalchemy.orm import aliased

from service.storage.models import AlarmChangeRow, AlarmRow, ConditionChangeRow, MotorRow
from service.storage.records import Alarm, AlarmChange
from service.storage.repository.sessions import Sessions, columns_of

WIDTH = len(fields(AlarmChange))


class JournalRows(Sessions):
    def latest_alarm_change(self) -> int:
        """Return the number of the latest thing that happened to an alarm; 0 where none has."""
        with self._read() as session:
            return session.scalar(select(func.max(AlarmChangeRow.sequence))) or 0

    def alarm_sequences(self, after: int, *, limit: int) -> Sequence[int]:
        """Return the numbers beyond `after` of what happened to alarms, the lowest first.

        A number may turn up later than a higher one: transactions end in any order.
        """
        query = select(AlarmChangeRow.sequence).where(AlarmChangeRow.sequence > after)
        with self._read() as session:
            return session.scalars(query.order_by(AlarmChangeRow.sequence).limit(limit)).all()

    def alarm_changes_of(self, sequences: Collection[int]) -> Sequence[tuple[AlarmChange, Alarm]]:
        """Return what has these numbers, each with its alarm as it is now."""
        query = (
            select(*columns_of(AlarmChange, AlarmChangeRow), *columns_of(Alarm, AlarmRow))
            .join(AlarmRow, AlarmRow.id == AlarmChangeRow.alarm)
            .where(AlarmChangeRow.sequence.in_(sequences))
            .order_by(AlarmChangeRow.sequence)
        )
        with self._read() as session:
            return [(AlarmChange(*row[:WIDTH]), Alarm(*row[WIDTH:])) for row in session.execute(query)]

    def latest_condition_changes(self) -> Mapping[str, tuple[int, Sequence[str]]]:
        """Return the latest time at which each motor in service changed, and the ids of the changes then.

        A motor that never changed is not there.
        """
        change = aliased(ConditionChangeRow)
        # One look into the index of each motor's changes, however many there are.
        latest = select(func.max(change.time_ns)).where(change.motor == MotorRow.name).scalar_subquery()
        query = (
            select(MotorRow.name, ConditionChangeRow.time_ns, ConditionChangeRow.id)
            .join(ConditionChangeRow, ConditionChangeRow.motor == MotorRow.name)
            .where(MotorRow.in_service, ConditionChangeRow.time_ns == latest)
            .order_by(MotorRow.name, ConditionChangeRow.id)
        )
        found: dict[str, tuple[int, list[str]]] = {}
        with self._read() as session:
            for motor, time_ns, change_id in session.execute(query):
                found.setdefault(motor, (time_ns, []))[1].append(change_id)
        return found
