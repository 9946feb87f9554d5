"""Lists of alarms, and the history of one."""

from collections.abc import Collection
from dataclasses import dataclass

from sqlalchemy import Select, or_, select

from service.storage.models import AlarmChangeRow, AlarmRow
from service.storage.models.alarms import is_open
from service.storage.records import Alarm, AlarmChange, Cursor, Page
from service.storage.repository.sessions import (
    Order,
    Sessions,
    columns_of,
    found,
    page_of,
    record_of,
)
from service.storage.states import AlarmState


@dataclass(frozen=True, slots=True)
class AlarmFilter:
    """Which alarms a list has; None for all. text: in the name of the motor, or of the relay."""

    site: str | None = None
    relay: str | None = None
    motor: str | None = None
    standing: bool | None = None
    state: AlarmState | None = None
    states: Collection[AlarmState] | None = None
    part_of: str | None = None
    text: str | None = None


class AlarmLists(Sessions):
    def alarm(self, alarm_id: str) -> Alarm:
        """Return one alarm. Raises NotFoundError."""
        with self._read() as session:
            return record_of(Alarm, found(session, AlarmRow, alarm_id, "alarm"))

    def standing_alarms(self, relay: str) -> tuple[Alarm, ...]:
        """Return the alarms about a relay itself whose cause stands, oldest first."""
        query = (
            select(AlarmRow)
            .where(AlarmRow.ied == relay, AlarmRow.motor.is_(None), AlarmRow.cleared_ns.is_(None))
            .order_by(AlarmRow.raised_ns, AlarmRow.id)
        )
        with self._read() as session:
            return tuple(record_of(Alarm, row) for row in session.scalars(query))

    def alarms(
        self,
        *,
        limit: int,
        after: Cursor | None = None,
        relay: str | None = None,
        motor: str | None = None,
        standing: bool | None = None,
        part_of: str | None = None,
        site: str | None = None,
        text: str | None = None,
    ) -> Page[Alarm]:
        """Return a page of alarms, latest first.

        relay, motor, site: None for all. standing: True for alarms whose cause stands, False for cleared
        ones, None for both. part_of: only those that this alarm tells in one line. text: only those whose
        motor or relay has it in its name.
        """
        chosen = AlarmFilter(site, relay, motor, standing=standing, part_of=part_of, text=text)
        query = _chosen(chosen)
        order: Order = [AlarmRow.raised_ns, AlarmRow.id]
        with self._read() as session:
            return page_of(session, query, order, Alarm, limit=limit, after=after, descending=True)

    def open_alarms(
        self,
        *,
        limit: int,
        after: Cursor | None = None,
        site: str | None = None,
        relay: str | None = None,
        motor: str | None = None,
        state: AlarmState | None = None,
        states: Collection[AlarmState] | None = None,
        text: str | None = None,
    ) -> Page[Alarm]:
        """Return a page of the alarms that are not over, what to act on first at the top.

        site, relay, motor, state, states: None for all. text: only those whose motor or relay has it in its
        name.
        """
        chosen = AlarmFilter(site, relay, motor, state=state, states=states, text=text)
        query = _chosen(chosen).where(is_open())
        order: Order = [AlarmRow.urgency, AlarmRow.raised_ns, AlarmRow.id]
        with self._read() as session:
            return page_of(session, query, order, Alarm, limit=limit, after=after, descending=True)

    def alarm_changes(self, alarm_id: str, *, limit: int, after: Cursor | None = None) -> Page[AlarmChange]:
        """Return what happened to an alarm, latest first. Raises NotFoundError."""
        query = select(*columns_of(AlarmChange, AlarmChangeRow)).where(AlarmChangeRow.alarm == alarm_id)
        with self._read() as session:
            found(session, AlarmRow, alarm_id, "alarm")
            order: Order = [AlarmChangeRow.sequence]
            return page_of(session, query, order, AlarmChange, limit=limit, after=after, descending=True)


def _chosen(chosen: AlarmFilter) -> Select[*tuple[object, ...]]:
    query = select(*columns_of(Alarm, AlarmRow))
    if chosen.site is not None:
        query = query.where(AlarmRow.site == chosen.site)
    if chosen.relay is not None:
        query = query.where(AlarmRow.ied == chosen.relay)
    if chosen.motor is not None:
        query = query.where(AlarmRow.motor == chosen.motor)
    if chosen.part_of is not None:
        query = query.where(AlarmRow.part_of == chosen.part_of)
    if chosen.state is not None:
        query = query.where(AlarmRow.state == chosen.state)
    if chosen.states is not None:
        query = query.where(AlarmRow.state.in_(chosen.states))
    if chosen.text is not None:
        named = (column.icontains(chosen.text, autoescape=True) for column in (AlarmRow.motor, AlarmRow.ied))
        query = query.where(or_(*named))
    if chosen.standing is not None:
        cleared = AlarmRow.cleared_ns
        query = query.where(cleared.is_(None) if chosen.standing else cleared.is_not(None))
    return query
