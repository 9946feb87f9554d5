"""One alarm for many: a site that is lost, and floods of alarms. Their members are suppressed meanwhile."""

from collections import Counter
from collections.abc import Sequence

from sqlalchemy import case, func, or_, select
from sqlalchemy.orm import Session

from core.units import NANOSECONDS_PER_SECOND
from service.alarms.floods import Flood, FreshAlarm, floods, is_over, told
from service.alarms.kinds import FOLLOW_FROM_SITE_LOST, AlarmKind, AlarmPriority
from service.storage.engine import one_at_a_time
from service.storage.models import AlarmRow
from service.storage.models.alarms import in_state
from service.storage.records import AlarmPlace, AlarmSpec
from service.storage.repository.alarms.causes import at_place, clear, forget_cleared, raised_at
from service.storage.repository.alarms.changes import locked
from service.storage.repository.alarms.suppression import (
    CALLING,
    suppress,
    suppress_all_by_design,
    unsuppress,
)
from service.storage.repository.sessions import Sessions

MINUTE_NS = 60 * NANOSECONDS_PER_SECOND

FLOODS = "floods of alarms"

AT_A_TIME = 100
"""So many alarms join a flood in one transaction, so that nobody waits for long."""


class AlarmGroupRows(Sessions):
    def lose_site(self, site: str, reason: str, *, since_ns: int, now_ns: int) -> None:
        """Raise the alarm of a site that is lost, and suppress what followed from that since it began."""
        with self._write() as session:
            one_at_a_time(session.connection(), f"alarms of {site}")
            spec = AlarmSpec(AlarmKind.SITE_LOST, reason, one_of_kind=True)
            raised_at(session, AlarmPlace(site=site), spec, now_ns=now_ns)
            members = locked(
                session,
                AlarmRow.site == site,
                AlarmRow.kind.in_(FOLLOW_FROM_SITE_LOST),
                AlarmRow.raised_ns >= since_ns,
                or_(*(in_state(state) for state in CALLING)),
            )
            for row in members:
                suppress(session, row, f"site {site} is lost", now_ns=now_ns)

    def regain_site(self, site: str, why: str, *, now_ns: int) -> None:
        """Clear the alarm of a site that is back; what still stands there calls when suppressions end."""
        place = AlarmPlace(site=site)
        with self._write() as session:
            one_at_a_time(session.connection(), f"alarms of {site}")
            clear(session, now_ns, AlarmRow.kind == AlarmKind.SITE_LOST, *at_place(place), why=why)
            forget_cleared(session, *at_place(place))

    def gather_floods(self, most: int, *, now_ns: int) -> int:
        """Tell floods of alarms in one line each, and end those that have run off; return how many stand.

        most: so many alarms of a priority are told one by one within a minute.
        """
        with self._read() as session:
            stands = session.scalar(select(AlarmRow.id).where(*_ARE_FLOODS).limit(1)) is not None
            found = floods(_fresh(session, now_ns), most)
        if not stands and not found:
            return 0
        for flood in found:
            with self._write() as session:
                group = _raised(session, flood, now_ns)
            ids = sorted(member.id for member in flood.members)
            for first in range(0, len(ids), AT_A_TIME):
                with self._write() as session:
                    _join(session, group, ids[first : first + AT_A_TIME], now_ns)
        with self._write() as session:
            one_at_a_time(session.connection(), FLOODS)
            return sum(not _ended(session, row, most, now_ns) for row in locked(session, *_ARE_FLOODS))


_ARE_FLOODS = (AlarmRow.kind == AlarmKind.ALARM_FLOOD, AlarmRow.cleared_ns.is_(None))


def _fresh(session: Session, now_ns: int) -> tuple[FreshAlarm, ...]:
    """Return the alarms that were raised within the last minute and that call, or are told by a flood."""
    query = select(AlarmRow.id, AlarmRow.site, AlarmRow.priority, AlarmRow.kind).where(
        AlarmRow.raised_ns > now_ns - MINUTE_NS,
        AlarmRow.kind != AlarmKind.ALARM_FLOOD,
        or_(*(in_state(state) for state in CALLING), AlarmRow.part_of.is_not(None)),
    )
    return tuple(FreshAlarm(*row) for row in session.execute(query))


def _raised(session: Session, flood: Flood, now_ns: int) -> str:
    """Raise the alarm of a flood, or find the one that stands; return its id."""
    one_at_a_time(session.connection(), FLOODS)
    priority = AlarmPriority(str(flood.priority))
    numbers = Counter(member.kind for member in flood.members)
    reason, subject = told(numbers, len(flood.members)), f"{priority.value} alarms"
    spec = AlarmSpec(AlarmKind.ALARM_FLOOD, reason, subject, priority=priority)
    return raised_at(session, AlarmPlace(site=flood.site), spec, now_ns=now_ns).id


def _join(session: Session, group: str, ids: Sequence[str], now_ns: int) -> None:
    """Have some alarms told by another one, and suppress them."""
    rows = locked(session, AlarmRow.id.in_(ids), AlarmRow.part_of.is_distinct_from(group))
    for row in rows:
        row.part_of = group
    suppress_all_by_design(session, rows, now_ns=now_ns)


def _ended(session: Session, group: AlarmRow, most: int, now_ns: int) -> bool:
    """Tell how many a flood has; end it when so few of them stand that they can be read.

    Returns whether it has ended.
    """
    standing = func.sum(case((AlarmRow.cleared_ns.is_(None), 1), else_=0))
    members = select(AlarmRow.kind, func.count(), standing).where(AlarmRow.part_of == group.id)
    counts = session.execute(members.group_by(AlarmRow.kind)).all()
    group.reason = told({kind: number for kind, number, _ in counts}, sum(stand for *_, stand in counts))
    if group.raised_ns > now_ns - MINUTE_NS or not is_over(sum(stand for *_, stand in counts), most):
        return False
    clear(session, now_ns, AlarmRow.id == group.id, why=group.reason)
    unsuppress(session, AlarmRow.part_of == group.id, now_ns=now_ns)
    return True
