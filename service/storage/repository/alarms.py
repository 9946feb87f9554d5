"""What somebody has to look after: raised once, standing until cleared, kept afterwards.

Alarms of relays are raised and cleared here, those of motors with their condition (`condition_alarms`).
"""

import uuid
from collections.abc import Collection

from sqlalchemy import ColumnElement, delete, select, update
from sqlalchemy.orm import Session

from service.storage.models import AlarmRow, IedRow
from service.storage.records import Alarm, Cursor, Page
from service.storage.repository.sessions import Order, Sessions, columns_of, found, only, page_of, record_of
from service.storage.repository.standing_alarm_counts import count_cleared, count_raised
from service.storage.states import AlarmKind

MOST_CLEARED = 1000
"""So many cleared alarms are kept of each relay and of each motor; older ones are deleted."""


class AlarmRows(Sessions):
    def raise_alarm(self, relay: str, kind: AlarmKind, subject: str, reason: str, *, now_ns: int) -> Alarm:
        """Raise an alarm; one that stands already gets the new reason.

        Raises NotFoundError.
        """
        with self._write() as session:
            found(session, IedRow, relay, "relay", lock=True)
            return alarm(raised(session, relay, kind, subject, reason, now_ns))

    def clear_alarms_of(self, relay: str, kind: AlarmKind, *, now_ns: int) -> None:
        """Clear the standing alarms of a kind about a relay; no change without any."""
        standing = select(AlarmRow.id).where(
            AlarmRow.ied == relay, AlarmRow.kind == kind, AlarmRow.cleared_ns.is_(None)
        )
        with self._read() as session:
            if session.scalars(standing.limit(1)).first() is None:
                return
        with self._write() as session:
            clear_standing(session, relay, kind, now_ns)
            forget_cleared(session, AlarmRow.ied == relay, AlarmRow.motor.is_(None))

    def clear_alarms(self, relay: str, alarm_ids: Collection[str], *, now_ns: int) -> None:
        """Clear alarms; those that were cleared before stay as they are."""
        with self._write() as session:
            clear(session, now_ns, AlarmRow.id.in_(alarm_ids))
            forget_cleared(session, AlarmRow.ied == relay, AlarmRow.motor.is_(None))

    def standing_alarms(self, relay: str) -> tuple[Alarm, ...]:
        """Return the alarms about a relay itself that are not cleared, oldest first."""
        query = (
            select(AlarmRow)
            .where(AlarmRow.ied == relay, AlarmRow.motor.is_(None), AlarmRow.cleared_ns.is_(None))
            .order_by(AlarmRow.raised_ns, AlarmRow.id)
        )
        with self._read() as session:
            return tuple(alarm(row) for row in session.scalars(query))

    def alarms(
        self,
        *,
        limit: int,
        after: Cursor | None = None,
        relay: str | None = None,
        motor: str | None = None,
        standing: bool | None = None,
    ) -> Page[Alarm]:
        """Return a page of alarms, latest first.

        relay, motor: None for all. standing: True for alarms that stand, False for cleared ones, None for
        both.
        """
        query = select(*columns_of(Alarm, AlarmRow))
        if relay is not None:
            query = query.where(AlarmRow.ied == relay)
        if motor is not None:
            query = query.where(AlarmRow.motor == motor)
        if standing is not None:
            query = query.where(
                AlarmRow.cleared_ns.is_(None) if standing else AlarmRow.cleared_ns.is_not(None)
            )
        order: Order = [AlarmRow.raised_ns, AlarmRow.id]
        with self._read() as session:
            return page_of(session, query, order, Alarm, limit=limit, after=after, descending=True)


def raised(session: Session, relay: str, kind: AlarmKind, subject: str, reason: str, now_ns: int) -> AlarmRow:
    """Raise an alarm, or give the standing one this reason, and return its row."""
    standing = select(AlarmRow).where(
        AlarmRow.ied == relay,
        AlarmRow.kind == kind,
        AlarmRow.subject == subject,
        AlarmRow.cleared_ns.is_(None),
    )
    row = only(session, standing)
    if row is None:
        row = AlarmRow(
            id=str(uuid.uuid4()), ied=relay, kind=kind, subject=subject, reason=reason, raised_ns=now_ns
        )
        session.add(row)
        count_raised(session, relay, kind)
    row.reason = reason
    session.flush()
    return row


def clear_standing(session: Session, relay: str, kind: AlarmKind, now_ns: int) -> None:
    """Clear a relay's standing alarms of a kind."""
    clear(session, now_ns, AlarmRow.ied == relay, AlarmRow.kind == kind)


def clear(session: Session, now_ns: int, *which: ColumnElement[bool]) -> None:
    """Clear the standing alarms that meet all conditions."""
    cleared = session.execute(
        update(AlarmRow)
        .where(*which, AlarmRow.cleared_ns.is_(None))
        .values(cleared_ns=now_ns)
        .returning(AlarmRow.ied, AlarmRow.kind)
    )
    count_cleared(session, [(ied, kind) for ied, kind in cleared])


def forget_cleared(session: Session, *of: ColumnElement[bool]) -> None:
    """Delete the oldest cleared alarms of a relay or a motor, beyond those that are kept."""
    cleared = select(AlarmRow.id).where(*of, AlarmRow.cleared_ns.is_not(None))
    too_old = cleared.order_by(AlarmRow.cleared_ns.desc(), AlarmRow.id.desc()).offset(MOST_CLEARED)
    session.execute(delete(AlarmRow).where(AlarmRow.id.in_(session.scalars(too_old).all())))


def alarm(row: AlarmRow) -> Alarm:
    return record_of(Alarm, row)
