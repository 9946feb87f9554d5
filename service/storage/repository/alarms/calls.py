"""When alarms called for somebody in a time, and what became of each call until its end."""

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from service.storage.models import AlarmChangeRow, AlarmRow
from service.storage.models.alarms import announced
from service.storage.records import Alarm, AlarmCall, AlarmChange
from service.storage.repository.sessions import Sessions, columns_of
from service.storage.states import AlarmEvent, AlarmState

GONE = (AlarmEvent.CLEARED, AlarmEvent.SUPERSEDED)
ASKED_AT_ONCE = 500


class AlarmCallRows(Sessions):
    def alarm_calls(
        self, *, from_ns: int, to_ns: int, limit: int, sites: Collection[str] | None = None
    ) -> tuple[AlarmCall, ...]:
        """Return the latest calls, from_ns <= time < to_ns, oldest first; sites: None for all.

        What happened to them later than that is left out: the same time tells the same later on.
        """
        query = (
            select(AlarmChangeRow.sequence, AlarmChangeRow.alarm)
            .where(
                announced(),
                AlarmChangeRow.before != AlarmState.UNACKNOWLEDGED,
                AlarmChangeRow.changed_ns >= from_ns,
                AlarmChangeRow.changed_ns < to_ns,
            )
            .order_by(AlarmChangeRow.changed_ns.desc(), AlarmChangeRow.sequence.desc())
            .limit(limit)
        )
        if sites is not None:
            query = query.join(AlarmRow, AlarmRow.id == AlarmChangeRow.alarm).where(AlarmRow.site.in_(sites))
        with self._read() as session:
            calls = dict(session.execute(query).all())
            ids = sorted(set(calls.values()))
            alarms = _alarms(session, ids)
            changes = _changes(session, ids, to_ns)
        told = (_told(alarms[alarm], sequence, changes[alarm]) for sequence, alarm in calls.items())
        return tuple(sorted(told, key=lambda call: (call.called_ns, call.alarm.id)))

    def number_of_alarm_calls(self, *, from_ns: int, to_ns: int, sites: Collection[str] | None = None) -> int:
        """Return how many calls there were, from_ns <= time < to_ns."""
        query = select(func.count()).where(
            announced(),
            AlarmChangeRow.before != AlarmState.UNACKNOWLEDGED,
            AlarmChangeRow.changed_ns >= from_ns,
            AlarmChangeRow.changed_ns < to_ns,
        )
        if sites is not None:
            query = query.where(AlarmRow.id == AlarmChangeRow.alarm, AlarmRow.site.in_(sites))
        with self._read() as session:
            return session.scalar(query) or 0


def _pieces(ids: Sequence[str]) -> Iterator[Sequence[str]]:
    """Return the ids in pieces: a statement has room for so many parameters."""
    for begin in range(0, len(ids), ASKED_AT_ONCE):
        yield ids[begin : begin + ASKED_AT_ONCE]


def _alarms(session: Session, ids: Sequence[str]) -> Mapping[str, Alarm]:
    columns = columns_of(Alarm, AlarmRow)
    return {
        row[0]: Alarm(*row)
        for piece in _pieces(ids)
        for row in session.execute(select(*columns).where(AlarmRow.id.in_(piece)))
    }


def _changes(session: Session, ids: Sequence[str], to_ns: int) -> Mapping[str, Sequence[AlarmChange]]:
    """Return what happened to each of the alarms before a time, in its order."""
    found: dict[str, list[AlarmChange]] = defaultdict(list)
    for piece in _pieces(ids):
        query = (
            select(*columns_of(AlarmChange, AlarmChangeRow))
            .where(AlarmChangeRow.alarm.in_(piece), AlarmChangeRow.changed_ns < to_ns)
            .order_by(AlarmChangeRow.sequence)
        )
        for row in session.execute(query):
            change = AlarmChange(*row)
            found[change.alarm].append(change)
    return found


def _told(alarm: Alarm, sequence: int, changes: Sequence[AlarmChange]) -> AlarmCall:
    """Return a call with what became of it before the alarm called again."""
    call = next(one for one in changes if one.sequence == sequence)
    later = [one for one in changes if one.sequence > sequence]
    again = next((at for at, one in enumerate(later) if _calls(one)), len(later))
    until = later[:again]
    acknowledged = next((one for one in until if one.event is AlarmEvent.ACKNOWLEDGED), None)
    gone = next((one for one in until if one.event in GONE), None)
    return AlarmCall(
        alarm=alarm,
        called_ns=call.changed_ns,
        acknowledged_ns=None if acknowledged is None else acknowledged.changed_ns,
        acknowledged_by=None if acknowledged is None else acknowledged.by,
        comment=None if acknowledged is None else acknowledged.comment,
        gone_ns=None if gone is None else gone.changed_ns,
        state=(until or [call])[-1].after,
    )


def _calls(change: AlarmChange) -> bool:
    return change.after is AlarmState.UNACKNOWLEDGED and change.before is not AlarmState.UNACKNOWLEDGED
