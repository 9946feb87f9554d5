"""What a message about alarms says, looked up when it is first sent: the alarms as they are then."""

from collections import Counter
from collections.abc import Mapping, Sequence

from sqlalchemy import select
from sqlalchemy.orm import Session

from service.storage.models import AlarmChangeRow, AlarmRow, NotificationAlarmRow, NotificationRow
from service.storage.states import AlarmPriority, AlarmState, NotificationKind, NotifiedEvent

MOST_LISTED = 50
"""So many alarms are told one by one; the others are counted."""

CALLS = (NotifiedEvent.RAISED, NotifiedEvent.REOPENED)
QUIET = (AlarmState.NORMAL, AlarmState.SHELVED, AlarmState.SUPPRESSED, AlarmState.OUT_OF_SERVICE)
"""Nobody has to look after an alarm in one of these states."""

Told = tuple[NotifiedEvent, AlarmRow, AlarmChangeRow]


def compose(session: Session, row: NotificationRow) -> tuple[Mapping[str, object] | None, bool]:
    """Return what a message says, and whether it may have something to say later; None: not now."""
    query = (
        select(NotificationAlarmRow.event, AlarmRow, AlarmChangeRow)
        .join(AlarmRow, AlarmRow.id == NotificationAlarmRow.alarm)
        .join(AlarmChangeRow, AlarmChangeRow.sequence == NotificationAlarmRow.sequence)
        .where(NotificationAlarmRow.notification == row.id)
        .order_by(NotificationAlarmRow.sequence)
    )
    everything = _latest(session.execute(query).all())
    kept = [told for told in everything if _is_told(row, told)]
    if not kept:
        waits = any(alarm.state is AlarmState.RETURNED_UNACKNOWLEDGED for _, alarm, _ in everything)
        return None, waits and row.kind is NotificationKind.ESCALATION
    order = tuple(AlarmPriority)
    kept.sort(key=lambda told: (told[0] not in CALLS, order.index(told[1].priority)))
    calls = [alarm.priority for event, alarm, _ in kept if event in CALLS]
    row.priority = min(calls, key=order.index) if calls else None
    counts = Counter((event.value, alarm.kind.value) for event, alarm, _ in kept)
    return {
        "number": len(kept),
        "counts": [
            {"event": event, "kind": kind, "number": number}
            for (event, kind), number in counts.most_common(MOST_LISTED)
        ],
        "alarms": [_facts(*told) for told in kept[:MOST_LISTED]],
    }, False


def _latest(found: Sequence[Told]) -> list[Told]:
    """Return the latest thing that calls, and the latest that does not, of each alarm."""
    latest = {(alarm.id, event in CALLS): (event, alarm, change) for event, alarm, change in found}
    return list(latest.values())


def _is_told(row: NotificationRow, told: Told) -> bool:
    """Tell whether there is still a reason to tell what happened to an alarm."""
    event, alarm, _ = told
    if row.kind is NotificationKind.ESCALATION:
        return alarm.state is AlarmState.UNACKNOWLEDGED
    if event in CALLS:
        return alarm.state is AlarmState.UNACKNOWLEDGED if row.is_held else alarm.state not in QUIET
    if event is NotifiedEvent.CLEARED:
        return alarm.cleared_ns is not None
    return True


def _facts(event: NotifiedEvent, alarm: AlarmRow, change: AlarmChangeRow) -> Mapping[str, object]:
    return {
        "id": alarm.id,
        "event": event.value,
        "time_ns": change.changed_ns,
        "by": change.by,
        "comment": change.comment,
        "kind": alarm.kind.value,
        "priority": alarm.priority.value,
        "site": alarm.site,
        "ied": alarm.ied,
        "motor": alarm.motor,
        "subject": alarm.subject,
        "reason": alarm.reason,
        "advice": alarm.advice,
        "recording_id": alarm.recording_id,
        "state": alarm.state.value,
        "standing": alarm.cleared_ns is None,
        "raised_ns": alarm.raised_ns,
        "raises": alarm.raises,
    }
