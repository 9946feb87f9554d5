"""One step in the life of an alarm: its new state and a row of its journal, in one transaction."""

from collections.abc import Sequence

from sqlalchemy import ColumnElement, delete, select
from sqlalchemy.orm import Session

from service.storage.alarm_transitions import following
from service.storage.errors import AlarmActionError
from service.storage.models import AlarmChangeRow, AlarmRow
from service.storage.records.actors import SERVICE
from service.storage.states import AlarmEvent, AlarmPriority, AlarmState
from service.storage.texts import storable

MOST_CHANGES = 1000
"""So many changes are kept of each alarm: one that comes and goes all day must not fill the disk."""

_RANK_OF_STATE = {
    AlarmState.UNACKNOWLEDGED: 3,
    AlarmState.ACKNOWLEDGED: 2,
    AlarmState.RETURNED_UNACKNOWLEDGED: 1,
}
_RANK_OF_PRIORITY = {
    AlarmPriority.CRITICAL: 3,
    AlarmPriority.HIGH: 2,
    AlarmPriority.MEDIUM: 1,
    AlarmPriority.LOW: 0,
}


def urgency(state: AlarmState, priority: AlarmPriority) -> int:
    """Return how far up an alarm stands in a list of what to act on first."""
    return 10 * _RANK_OF_STATE.get(state, 0) + _RANK_OF_PRIORITY[priority]


def locked(session: Session, *which: ColumnElement[bool]) -> Sequence[AlarmRow]:
    """Return the alarms that meet all conditions, as they are now, and keep others from changing them.

    In the order of their ids, so that two who lock several wait for each other in no circle.
    """
    query = select(AlarmRow).where(*which).order_by(AlarmRow.id).with_for_update(key_share=True)
    return session.scalars(query.execution_options(populate_existing=True)).all()


def change(
    session: Session,
    row: AlarmRow,
    event: AlarmEvent,
    *,
    now_ns: int,
    by: str = SERVICE.name,
    comment: str | None = None,
    until: str | None = None,
) -> None:
    """Let an event happen to a locked alarm, whose `cleared_ns` tells the cause as it is afterwards.

    until: the end of a shelving in words, which the journal has before the comment: the alarm forgets it.

    Raises AlarmActionError where it is not possible in the alarm's state.
    """
    before = row.state
    after = following(before, event, standing=row.cleared_ns is None)
    if after is None:
        said = "" if row.comment is None else f": {row.comment}"
        raise AlarmActionError(row.id, event, before, why=f"by {row.changed_by}{said}")
    comment = None if comment is None else storable(comment)
    session.add(
        AlarmChangeRow(
            alarm=row.id,
            changed_ns=now_ns,
            event=event,
            before=before,
            after=after,
            by=storable(by),
            comment="; ".join(words for words in (until, comment) if words) or None,
        )
    )
    row.state, row.urgency = after, urgency(after, row.priority)
    if after is not before or event is AlarmEvent.SHELVED:
        row.changed_ns, row.changed_by = now_ns, storable(by)
        row.comment = None if event is AlarmEvent.RAISED else comment  # the alarm says its reason anyway
    if after is not AlarmState.SHELVED:
        row.shelved_until_ns = row.shelved_above = None
    if after is not AlarmState.SUPPRESSED:
        row.suppressed_because = None


def forget_changes(session: Session, alarm_id: str) -> None:
    """Delete the oldest changes of an alarm beyond those that are kept, if notifications have seen them."""
    of_alarm = select(AlarmChangeRow.sequence).where(AlarmChangeRow.alarm == alarm_id)
    too_old = of_alarm.order_by(AlarmChangeRow.sequence.desc()).offset(MOST_CHANGES)
    last = session.scalar(too_old.limit(1))
    if last is not None:
        session.execute(
            delete(AlarmChangeRow).where(
                AlarmChangeRow.alarm == alarm_id,
                AlarmChangeRow.sequence <= last,
                AlarmChangeRow.routed_ns.is_not(None),
            )
        )
