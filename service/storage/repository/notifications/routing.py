"""Messages made from what happened to alarms.

Each row of the journal of alarms is looked at once, in the transaction that makes its messages: none is
missed and none is told twice, however many services look.
"""

import uuid
from collections.abc import Callable, Sequence

from sqlalchemy import func, insert, select
from sqlalchemy.orm import Session

from service.storage.engine import one_at_a_time
from service.storage.models import AlarmChangeRow, AlarmRow, NotificationAlarmRow, NotificationRow
from service.storage.records import Gathering, NotificationTarget, Occurrence
from service.storage.repository.sessions import Sessions, only
from service.storage.states import (
    AlarmEvent,
    AlarmPriority,
    AlarmState,
    NotificationKind,
    NotificationState,
    NotifiedEvent,
)

Decide = Callable[[Occurrence], Sequence[NotificationTarget]]
"""Who is told of what happened to an alarm."""

REPEATED_NS = 3600 * 10**9
"""An alarm that nobody has acknowledged calls again when its cause comes back later than this."""

ORDER = tuple(AlarmPriority)
"""Priorities, the most urgent first."""

CALM = (AlarmState.SHELVED, AlarmState.SUPPRESSED, AlarmState.OUT_OF_SERVICE)


class RoutingRows(Sessions):
    def route_alarm_changes(
        self, decide: Decide, gathering: Gathering, *, now_ns: int, limit: int = 100
    ) -> int:
        """Make the messages of what happened to alarms since the last look; return how many rows it saw."""
        unrouted = select(AlarmChangeRow.sequence).where(AlarmChangeRow.routed_ns.is_(None)).limit(1)
        with self._read() as session:
            if session.scalars(unrouted).first() is None:
                return 0
        with self._write() as session:
            one_at_a_time(session.connection(), "route alarms")
            query = (
                select(AlarmChangeRow, AlarmRow)
                .join(AlarmRow, AlarmRow.id == AlarmChangeRow.alarm)
                .where(AlarmChangeRow.routed_ns.is_(None))
                .order_by(AlarmChangeRow.sequence)
                .limit(limit)
            )
            found = session.execute(query).all()
            bundles = _Bundles(session, gathering, now_ns)
            for change, alarm in found:
                change.routed_ns = now_ns
                event = _told_as(session, change)
                if event is None:
                    continue
                occurrence = Occurrence(event, alarm.site, alarm.priority, alarm.kind.value)
                for target in decide(occurrence):
                    bundles.add(target, change, alarm, event)
            bundles.write()
            return len(found)


class _Bundles:
    """The messages that alarms are gathered in."""

    def __init__(self, session: Session, gathering: Gathering, now_ns: int) -> None:
        self._session = session
        self._gathering = gathering
        self._now_ns = now_ns
        self._open: dict[str, NotificationRow] = {}
        self._told: list[dict[str, object]] = []

    def add(
        self, target: NotificationTarget, change: AlarmChangeRow, alarm: AlarmRow, event: NotifiedEvent
    ) -> None:
        """Tell a receiver what happened to an alarm, in a message that is still open, or in a new one."""
        name = _name(target, alarm.site)
        row = self._open.get(name) or self._found(name) or self._new(name, target, alarm)
        self._open[name] = row
        if row.priority is None or ORDER.index(alarm.priority) < ORDER.index(row.priority):
            row.priority = alarm.priority
        self._told.append(
            {"notification": row.id, "sequence": change.sequence, "alarm": alarm.id, "event": event}
        )

    def write(self) -> None:
        """Write which alarms are in which messages."""
        self._session.flush()
        if self._told:
            self._session.execute(insert(NotificationAlarmRow), self._told)

    def _found(self, name: str) -> NotificationRow | None:
        return only(
            self._session,
            select(NotificationRow)
            .where(
                NotificationRow.bundle == name,
                NotificationRow.closes_ns > self._now_ns,
                NotificationRow.state == NotificationState.QUEUED,
                NotificationRow.attempts == 0,
                NotificationRow.document.is_(None),
            )
            .with_for_update(),
        )

    def _new(self, name: str, target: NotificationTarget, alarm: AlarmRow) -> NotificationRow:
        gather_ns, pause_ns = self._gathering.gather_ns, self._gathering.pause_ns
        closes_ns = target.held_until_ns
        if closes_ns is None:
            latest_ns = self._session.scalar(
                select(func.max(NotificationRow.closes_ns)).where(NotificationRow.bundle == name)
            )
            closes_ns = self._now_ns + gather_ns
            if latest_ns is not None:
                # Later than that it is only where the clock was set back meanwhile.
                closes_ns = min(max(closes_ns, latest_ns + pause_ns), closes_ns + pause_ns)
        row = NotificationRow(
            id=str(uuid.uuid4()),
            kind=NotificationKind.ESCALATION if target.after_ns else NotificationKind.ALARMS,
            state=NotificationState.QUEUED,
            channel=target.channel,
            recipient=target.recipient,
            bundle=name,
            site=alarm.site,
            is_held=target.held_until_ns is not None,
            created_ns=self._now_ns,
            closes_ns=closes_ns,
            not_before_ns=closes_ns + target.after_ns,
            attempts=0,
        )
        self._session.add(row)
        self._session.flush()
        return row


def _name(target: NotificationTarget, site: str | None) -> str:
    """Return what alarms are gathered by: receiver, site, and when it is told."""
    kind = f"after {target.after_ns}" if target.after_ns else "at once"
    held = "" if target.held_until_ns is None else f" held until {target.held_until_ns}"
    return f"{target.channel} {target.recipient} {kind}{held} {'' if site is None else f'at {site}'}"


def _told_as(session: Session, change: AlarmChangeRow) -> NotifiedEvent | None:
    """Return as what a change of an alarm is told; None where nobody needs to know."""
    if change.event in (AlarmEvent.REOPENED, AlarmEvent.ACKNOWLEDGEMENT_UNDONE):
        return NotifiedEvent.REOPENED
    if change.event is AlarmEvent.ACKNOWLEDGED:
        return NotifiedEvent.ACKNOWLEDGED
    if change.event is AlarmEvent.CLEARED:
        return None if change.before in CALM else NotifiedEvent.CLEARED
    if change.after is not AlarmState.UNACKNOWLEDGED:
        return None
    if change.before is AlarmState.RETURNED_UNACKNOWLEDGED and _was_told(session, change):
        return None
    return NotifiedEvent.RAISED


def _was_told(session: Session, change: AlarmChangeRow) -> bool:
    """Tell whether people were called for the same alarm shortly before: it comes and goes."""
    earlier = select(AlarmChangeRow.sequence).where(
        AlarmChangeRow.alarm == change.alarm,
        AlarmChangeRow.sequence < change.sequence,
        AlarmChangeRow.after == AlarmState.UNACKNOWLEDGED,
        AlarmChangeRow.changed_ns > change.changed_ns - REPEATED_NS,
    )
    return session.scalars(earlier.limit(1)).first() is not None
