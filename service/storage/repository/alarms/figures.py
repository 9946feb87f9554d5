"""Key figures of the alarms: how many a day, the most frequent, chattering and long-standing ones."""

from collections.abc import Mapping
from heapq import nsmallest
from typing import Any

from sqlalchemy import ColumnElement, Select, func, or_, select
from sqlalchemy.orm import InstrumentedAttribute, Session

from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.storage.models import AlarmChangeRow, AlarmRow, IedRow
from service.storage.models.alarms import announced, is_open
from service.storage.records import Alarm, AlarmCause, AlarmFigures, CallsOfDay
from service.storage.repository.sessions import Sessions, columns_of
from service.storage.states import AlarmPriority, AlarmState

MOST_CAUSES = 20
"""So many of the most frequent, of the chattering and of the long-standing ones are named."""

CHATTERING_CALLS = 3
CHATTERING_WITHIN_NS = 3600 * NANOSECONDS_PER_SECOND
"""An alarm chatters that calls so often within this time. The causes are looked at every few seconds at the
soonest, and motors are recorded a few times a day, so the three calls within a minute of ISA-18.2 would find
none."""

OPEN = [state for state in AlarmState if state is not AlarmState.NORMAL]

LONG_NS = NANOSECONDS_PER_DAY

_CAUSE: list[InstrumentedAttribute[str | None]] = [AlarmRow.site, AlarmRow.ied, AlarmRow.motor]


class AlarmFigureRows(Sessions):
    def alarm_figures(self, *, from_ns: int, now_ns: int) -> AlarmFigures:
        """Return the key figures of the alarms from a time on."""
        with self._read() as session:
            long, in_all = _standing_long(session, now_ns)
            states = (
                select(AlarmRow.state, func.count())
                .where(is_open(), AlarmRow.state.in_(OPEN))  # found by the index, state by state
                .group_by(AlarmRow.state)
            )
            return AlarmFigures(
                from_ns=from_ns,
                to_ns=now_ns,
                days=_days(session, from_ns, now_ns),
                frequent=_frequent(session, from_ns),
                chattering=_chattering(session, from_ns),
                by_state=dict(session.execute(states).all()),
                standing_long=long,
                standing_long_in_all=in_all,
            )

    def open_alarm_counts(self) -> Mapping[tuple[AlarmState, AlarmPriority], int]:
        """Count the alarms that are not over, by state and priority; of relays, those in service only."""
        query = (
            select(AlarmRow.state, AlarmRow.priority, func.count())
            .outerjoin(IedRow, IedRow.name == AlarmRow.ied)
            .where(is_open(), AlarmRow.state.in_(OPEN), or_(AlarmRow.ied.is_(None), IedRow.in_service))
            .group_by(AlarmRow.state, AlarmRow.priority)
        )
        with self._read() as session:
            return {(state, priority): number for state, priority, number in session.execute(query)}


def _days(session: Session, from_ns: int, now_ns: int) -> tuple[CallsOfDay, ...]:
    day = AlarmChangeRow.changed_ns // NANOSECONDS_PER_DAY
    query = select(day, func.count()).where(*_calls(from_ns)).group_by(day)
    calls: dict[int, int] = dict(session.execute(query).all())
    first, last = from_ns // NANOSECONDS_PER_DAY, now_ns // NANOSECONDS_PER_DAY
    return tuple(CallsOfDay(day * NANOSECONDS_PER_DAY, calls.get(day, 0)) for day in range(first, last + 1))


def _frequent(session: Session, from_ns: int) -> tuple[AlarmCause, ...]:
    query = (
        select(*_CAUSE, AlarmRow.kind, AlarmRow.subject, func.count())
        .join(AlarmChangeRow, AlarmChangeRow.alarm == AlarmRow.id)
        .where(*_calls(from_ns))
        .group_by(*_CAUSE, AlarmRow.kind, AlarmRow.subject)
    )
    return _causes(session, query)


def _chattering(session: Session, from_ns: int) -> tuple[AlarmCause, ...]:
    """Return the causes that called often within a short time, and how often they did."""
    cause = [*_CAUSE, AlarmRow.kind, AlarmRow.subject]
    earlier = func.lag(AlarmChangeRow.changed_ns, CHATTERING_CALLS - 1).over(
        partition_by=cause, order_by=AlarmChangeRow.changed_ns
    )
    calls = (
        select(*cause, (AlarmChangeRow.changed_ns - earlier).label("within_ns"))
        .join(AlarmChangeRow, AlarmChangeRow.alarm == AlarmRow.id)
        .where(*_calls(from_ns))
        .subquery()
    )
    columns = [calls.c[name] for name in ("site", "ied", "motor", "kind", "subject")]
    query = select(*columns, func.count()).where(calls.c.within_ns <= CHATTERING_WITHIN_NS).group_by(*columns)
    return _causes(session, query)


def _causes(session: Session, query: Select[*tuple[Any, ...]]) -> tuple[AlarmCause, ...]:
    """Return the causes with the most calls; the database need not sort the others."""
    causes = [AlarmCause(*row) for row in session.execute(query)]
    return tuple(nsmallest(MOST_CAUSES, causes, key=_from_the_most_calls))


def _from_the_most_calls(cause: AlarmCause) -> tuple[int, str, str, str, str, str]:
    return -cause.calls, cause.site or "", cause.ied or "", cause.motor or "", cause.kind, cause.subject


def _standing_long(session: Session, now_ns: int) -> tuple[tuple[Alarm, ...], int]:
    old = (AlarmRow.cleared_ns.is_(None), AlarmRow.raised_ns < now_ns - LONG_NS)
    query = select(*columns_of(Alarm, AlarmRow)).where(*old).order_by(AlarmRow.raised_ns, AlarmRow.id)
    number = session.scalar(select(func.count()).select_from(AlarmRow).where(*old)) or 0
    return tuple(Alarm(*row) for row in session.execute(query.limit(MOST_CAUSES))), number


def _calls(from_ns: int) -> tuple[ColumnElement[bool], ...]:
    """Return the conditions that changes made alarms call for somebody from a time on."""
    return announced(), AlarmChangeRow.changed_ns >= from_ns
