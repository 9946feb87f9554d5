"""Key figures of the alarms: how many a day, the most frequent, chattering and long-standing ones."""

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from heapq import nsmallest

from sqlalchemy import func, or_, select
from sqlalchemy.orm import Session

from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.alarms.kinds import AlarmKind, AlarmPriority
from service.storage.models import AlarmChangeRow, AlarmRow, IedRow
from service.storage.models.alarms import announced, is_open
from service.storage.records import Alarm, AlarmCause, AlarmFigures, CallsOfDay
from service.storage.repository.sessions import Sessions, columns_of
from service.storage.states import AlarmState

MOST_CALLS = 20_000
"""The figures are those of so many of the latest calls: a database that was flooded answers in time, too."""

MOST_CAUSES = 20
"""So many of the most frequent, of the chattering and of the long-standing ones are named."""

CHATTERING_CALLS = 3
CHATTERING_WITHIN_NS = 3600 * NANOSECONDS_PER_SECOND
"""An alarm chatters that calls so often within this time. The causes are looked at every few seconds at the
soonest, and motors are recorded a few times a day, so the three calls within a minute of ISA-18.2 would find
none."""

OPEN = [state for state in AlarmState if state is not AlarmState.NORMAL]

LONG_NS = NANOSECONDS_PER_DAY

Cause = tuple[str | None, str | None, str | None, AlarmKind, str]
"""Site, relay, motor, kind and subject: what one cause of alarms is told from others by."""


class AlarmFigureRows(Sessions):
    def alarm_figures(self, *, from_ns: int, now_ns: int) -> AlarmFigures:
        """Return the key figures of the alarms from a time on, of the latest 20,000 calls at most."""
        with self._read() as session:
            calls, from_ns = _calls(session, from_ns)
            long, in_all = _standing_long(session, now_ns)
            states = (
                select(AlarmRow.state, func.count())
                .where(is_open(), AlarmRow.state.in_(OPEN))  # found by the index, state by state
                .group_by(AlarmRow.state)
            )
            return AlarmFigures(
                from_ns=from_ns,
                to_ns=now_ns,
                days=_days(calls, from_ns, now_ns),
                frequent=_most({cause: len(times) for cause, times in calls.items()}),
                chattering=_most({cause: _chattered(times) for cause, times in calls.items()}),
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


def _calls(session: Session, from_ns: int) -> tuple[Mapping[Cause, Sequence[int]], int]:
    """Return when each cause called for somebody, and from which time on: the given one, or a later one."""
    query = (
        select(
            AlarmChangeRow.changed_ns,
            AlarmRow.site,
            AlarmRow.ied,
            AlarmRow.motor,
            AlarmRow.kind,
            AlarmRow.subject,
        )
        .join(AlarmRow, AlarmRow.id == AlarmChangeRow.alarm)
        .where(announced(), AlarmChangeRow.changed_ns >= from_ns)
        .order_by(AlarmChangeRow.changed_ns.desc())
        .limit(MOST_CALLS)
    )
    rows = session.execute(query).all()
    calls: dict[Cause, list[int]] = defaultdict(list)
    for changed_ns, site, relay, motor, kind, subject in rows:
        calls[site, relay, motor, kind, subject].append(changed_ns)
    return calls, rows[-1][0] if len(rows) == MOST_CALLS else from_ns


def _days(calls: Mapping[Cause, Iterable[int]], from_ns: int, now_ns: int) -> tuple[CallsOfDay, ...]:
    number = Counter(time_ns // NANOSECONDS_PER_DAY for times in calls.values() for time_ns in times)
    first, last = from_ns // NANOSECONDS_PER_DAY, now_ns // NANOSECONDS_PER_DAY
    return tuple(CallsOfDay(day * NANOSECONDS_PER_DAY, number[day]) for day in range(first, last + 1))


def _chattered(times_ns: Iterable[int]) -> int:
    """Return how many calls were the third, or a later one, within an hour."""
    ordered = sorted(times_ns)
    back = CHATTERING_CALLS - 1
    return sum(
        later - earlier <= CHATTERING_WITHIN_NS
        for earlier, later in zip(ordered, ordered[back:], strict=False)
    )


def _most(numbers: Mapping[Cause, int]) -> tuple[AlarmCause, ...]:
    """Return the causes with the most calls, without those that have none."""
    causes = (AlarmCause(*cause, number) for cause, number in numbers.items() if number)
    return tuple(nsmallest(MOST_CAUSES, causes, key=_from_the_most_calls))


def _from_the_most_calls(cause: AlarmCause) -> tuple[int, str, str, str, str, str]:
    return -cause.calls, cause.site or "", cause.ied or "", cause.motor or "", cause.kind, cause.subject


def _standing_long(session: Session, now_ns: int) -> tuple[tuple[Alarm, ...], int]:
    old = (AlarmRow.cleared_ns.is_(None), AlarmRow.raised_ns < now_ns - LONG_NS)
    query = select(*columns_of(Alarm, AlarmRow)).where(*old).order_by(AlarmRow.raised_ns, AlarmRow.id)
    number = session.scalar(select(func.count()).select_from(AlarmRow).where(*old)) or 0
    return tuple(Alarm(*row) for row in session.execute(query.limit(MOST_CAUSES))), number
