"""What the causes of alarms do: they raise them, clear them, replace one by another, and become worse.

One cause has one alarm until that is over, however often it comes and goes: raised again before somebody
acknowledged it, it is the same row.
"""

import uuid
from collections.abc import Collection
from typing import Final

from sqlalchemy import ColumnElement, delete, select
from sqlalchemy.orm import InstrumentedAttribute, Session

from service.alarms.catalogue import CATALOGUE
from service.storage.alarm_transitions import TRANSITIONS
from service.storage.engine import one_at_a_time
from service.storage.models import AlarmRow, IedRow, MotorRow
from service.storage.models.alarms import is_open
from service.storage.records import Alarm, AlarmPlace, AlarmSpec
from service.storage.repository.alarms.changes import change, forget_changes, locked, urgency
from service.storage.repository.alarms.standing_counts import count_cleared, count_raised
from service.storage.repository.alarms.suppression import suppress, suppress_by_design, why_suppressed
from service.storage.repository.sessions import Sessions, found, record_of
from service.storage.states import AlarmEvent, AlarmKind, AlarmState
from service.storage.texts import storable

MOST_CLEARED = 1000
"""So many cleared alarms are kept of each relay and of each motor, and of each site and the service itself.

Older ones are deleted, with their history.
"""


LEFT_THE_PLANT: Final = "the motor left the plant"
"""Why alarms of a motor that is in service no more are over."""


class AlarmCauseRows(Sessions):
    def raise_alarm(self, relay: str, kind: AlarmKind, subject: str, reason: str, *, now_ns: int) -> Alarm:
        """Raise an alarm about a relay; one that stands already gets the new reason.

        Raises NotFoundError.
        """
        spec = AlarmSpec(kind, reason, subject)
        return self.raise_alarm_at(AlarmPlace(relay=relay), spec, now_ns=now_ns)

    def raise_alarm_at(self, place: AlarmPlace, spec: AlarmSpec, *, now_ns: int) -> Alarm:
        """Raise an alarm; one that stands already gets the new texts, priority and value.

        One that is shelved until it grows is reopened when its value is beyond that. Raises NotFoundError.
        """
        with self._write() as session:
            return alarm(raised_at(session, locked_place(session, place), spec, now_ns=now_ns))

    def clear_alarms_at(
        self,
        place: AlarmPlace,
        kind: AlarmKind,
        *,
        now_ns: int,
        subject: str | None = None,
        why: str | None = None,
    ) -> int:
        """Clear the standing alarms of a kind at a place; return how many. No change without any.

        subject: None for all. why: what shows that the cause is gone, for the history. Raises NotFoundError.
        """
        about = [AlarmRow.kind == kind, AlarmRow.cleared_ns.is_(None)]
        if subject is not None:
            about.append(AlarmRow.subject == subject)
        with self._read() as session:
            about += at_place(_completed(session, place))
            if session.scalars(select(AlarmRow.id).where(*about).limit(1)).first() is None:
                return 0
        with self._write() as session:
            complete = locked_place(session, place)
            number = clear(session, now_ns, *about, why=why)
            forget_cleared(session, *at_place(complete))
            return number

    def supersede_alarm(self, alarm_id: str, by_alarm: str, *, now_ns: int) -> None:
        """End an alarm because another one tells its cause from now on; harmless where it is over.

        Raises NotFoundError.
        """
        with self._write() as session:
            found(session, AlarmRow, alarm_id, "alarm")
            successor = found(session, AlarmRow, by_alarm, "alarm")
            for row in locked(session, AlarmRow.id == alarm_id):
                supersede(session, row, successor, now_ns=now_ns)

    def reopen_alarm(self, alarm_id: str, reason: str, *, now_ns: int, value: float | None = None) -> bool:
        """Have an alarm call again that was acknowledged or shelved, because it has become worse.

        Returns False, and changes nothing, where it calls already or is out of service. Raises NotFoundError.
        """
        with self._write() as session:
            row = found(session, AlarmRow, alarm_id, "alarm", lock=True)
            return reopen(session, row, reason, now_ns=now_ns, value=value)

    def clear_alarms_of(self, relay: str, kind: AlarmKind, *, now_ns: int) -> None:
        """Clear the standing alarms of a kind about a relay; no change without any."""
        about = (AlarmRow.ied == relay, AlarmRow.kind == kind, AlarmRow.cleared_ns.is_(None))
        with self._read() as session:
            if session.scalars(select(AlarmRow.id).where(*about).limit(1)).first() is None:
                return
        with self._write() as session:
            clear_standing(session, relay, kind, now_ns)
            forget_cleared(session, AlarmRow.ied == relay, AlarmRow.motor.is_(None))

    def clear_alarms(self, relay: str, alarm_ids: Collection[str], *, now_ns: int) -> None:
        """Clear alarms; those that were cleared before stay as they are."""
        with self._write() as session:
            clear(session, now_ns, AlarmRow.id.in_(alarm_ids))
            forget_cleared(session, AlarmRow.ied == relay, AlarmRow.motor.is_(None))


def raised(session: Session, relay: str, kind: AlarmKind, subject: str, reason: str, now_ns: int) -> AlarmRow:
    """Raise an alarm about a locked relay, or give the standing one this reason, and return its row."""
    place = _completed(session, AlarmPlace(relay=relay))
    return raised_at(session, place, AlarmSpec(kind, reason, subject), now_ns=now_ns)


def raised_at(session: Session, place: AlarmPlace, spec: AlarmSpec, *, now_ns: int) -> AlarmRow:
    """Raise an alarm at a complete place that is locked, and return its row."""
    about = [is_open(), AlarmRow.kind == spec.kind, *at_place(place)]
    if not spec.one_of_kind:
        about.append(AlarmRow.subject == storable(spec.subject))
    rows = locked(session, *about)
    row = rows[0] if rows else _new(place, spec, now_ns)
    _tell(row, spec)
    if rows and row.cleared_ns is None:
        _grow(session, row, now_ns)
        return row
    if not rows:
        session.add(row)
        session.flush()
    row.cleared_ns, row.raised_ns, row.raises = None, now_ns, row.raises + 1
    if row.ied is not None:
        count_raised(session, row.ied, row.kind)
    why = why_suppressed(session, row, now_ns=now_ns)
    if why is None:
        row.part_of = None  # the flood that it came with has run off
    if why is not None and row.state in TRANSITIONS[AlarmEvent.SUPPRESSED]:
        suppress(session, row, why, now_ns=now_ns)
    elif why is None and row.state is AlarmState.SUPPRESSED:
        change(session, row, AlarmEvent.UNSUPPRESSED, now_ns=now_ns)
    else:
        change(session, row, AlarmEvent.RAISED, now_ns=now_ns, comment=row.reason)
        _grow(session, row, now_ns)
    forget_changes(session, row.id)
    return row


def clear_standing(session: Session, relay: str, kind: AlarmKind, now_ns: int) -> None:
    """Clear a relay's standing alarms of a kind."""
    clear(session, now_ns, AlarmRow.ied == relay, AlarmRow.kind == kind)


def clear(session: Session, now_ns: int, *which: ColumnElement[bool], why: str | None = None) -> int:
    """Clear the standing alarms that meet all conditions; return how many."""
    rows = locked(session, *which, AlarmRow.cleared_ns.is_(None))
    for row in rows:
        row.cleared_ns = now_ns
        change(session, row, AlarmEvent.CLEARED, now_ns=now_ns, comment=why)
    count_cleared(session, [(row.ied, row.kind) for row in rows if row.ied is not None])
    return len(rows)


def end_of_motor(session: Session, motor: str, rows: Collection[AlarmRow], why: str, *, now_ns: int) -> None:
    """Clear those of a motor's locked alarms that stand, as their cause is over.

    The plant's design may suppress one that calls for somebody first.
    """
    for row in rows:
        suppress_by_design(session, row, now_ns=now_ns)
    standing = [row.id for row in rows if row.cleared_ns is None]
    if standing:
        clear(session, now_ns, AlarmRow.id.in_(standing), why=why)
        forget_cleared(session, AlarmRow.motor == motor)


def supersede(session: Session, row: AlarmRow, successor: AlarmRow, *, now_ns: int) -> None:
    """End a locked alarm whose cause another one tells from now on; harmless where it is over."""
    stood = row.cleared_ns is None
    if stood:
        row.cleared_ns = now_ns
        if row.ied is not None:
            count_cleared(session, [(row.ied, row.kind)])
    if row.state is not AlarmState.NORMAL and (stood or row.state is not AlarmState.OUT_OF_SERVICE):
        comment = f"by {successor.kind.value}, alarm {successor.id}"
        change(session, row, AlarmEvent.SUPERSEDED, now_ns=now_ns, comment=comment)


def reopen(session: Session, row: AlarmRow, reason: str, *, now_ns: int, value: float | None = None) -> bool:
    """Have a locked alarm call again that was acknowledged or shelved; return whether it was."""
    if value is not None:
        row.value = value
    if row.cleared_ns is not None or row.state not in TRANSITIONS[AlarmEvent.REOPENED]:
        return False
    change(session, row, AlarmEvent.REOPENED, now_ns=now_ns, comment=reason)
    forget_changes(session, row.id)
    return True


def forget_cleared(session: Session, *of: ColumnElement[bool]) -> None:
    """Delete the oldest cleared alarms of a place beyond those that are kept, with their history.

    Those that people have set aside stay: they wait for their causes to come again.
    """
    set_aside = (AlarmState.SHELVED, AlarmState.OUT_OF_SERVICE)
    cleared = select(AlarmRow.id).where(
        *of, AlarmRow.cleared_ns.is_not(None), AlarmRow.state.not_in(set_aside)
    )
    too_old = cleared.order_by(AlarmRow.cleared_ns.desc(), AlarmRow.id.desc()).offset(MOST_CLEARED)
    session.execute(delete(AlarmRow).where(AlarmRow.id.in_(session.scalars(too_old).all())))


def alarm(row: AlarmRow) -> Alarm:
    return record_of(Alarm, row)


def _new(place: AlarmPlace, spec: AlarmSpec, now_ns: int) -> AlarmRow:
    priority = spec.priority or CATALOGUE[spec.kind].priority
    return AlarmRow(
        id=str(uuid.uuid4()),
        site=place.site,
        ied=place.relay,
        motor=place.motor,
        kind=spec.kind,
        subject=storable(spec.subject),
        reason=storable(spec.reason),
        priority=priority,
        state=AlarmState.NORMAL,
        urgency=urgency(AlarmState.NORMAL, priority),
        raised_ns=now_ns,
        raises=0,
        changed_ns=now_ns,
        changed_by="",
    )


def _tell(row: AlarmRow, spec: AlarmSpec) -> None:
    """Give an alarm the present words, priority and value of its cause."""
    row.subject, row.reason = storable(spec.subject), storable(spec.reason)
    row.priority = spec.priority or CATALOGUE[spec.kind].priority
    row.urgency = urgency(row.state, row.priority)
    row.value = spec.value
    if spec.advice is not None:
        row.advice = storable(spec.advice)
    if spec.recording_id is not None:
        row.recording_id = spec.recording_id


def _grow(session: Session, row: AlarmRow, now_ns: int) -> None:
    """Have an alarm call again that was shelved until it grows, and has."""
    limit = row.shelved_above
    if row.state is AlarmState.SHELVED and limit is not None and row.value is not None and row.value > limit:
        reopen(session, row, f"it has grown to {row.value:.4g}, beyond {limit:.4g}", now_ns=now_ns)


def _completed(session: Session, place: AlarmPlace) -> AlarmPlace:
    """Return a place with the relay and the site that follow from its motor or relay.

    Raises NotFoundError.
    """
    if place.motor is not None:
        motor = found(session, MotorRow, place.motor, "motor")
        return AlarmPlace(motor.site, motor.ied, place.motor)
    if place.relay is not None:
        return AlarmPlace(found(session, IedRow, place.relay, "relay").site, place.relay)
    return place


def locked_place(session: Session, place: AlarmPlace) -> AlarmPlace:
    """Return a complete place, and let no other raise an alarm there until this transaction has ended."""
    if place.motor is not None:
        found(session, MotorRow, place.motor, "motor", lock=True)
    elif place.relay is not None:
        found(session, IedRow, place.relay, "relay", lock=True)
    else:
        one_at_a_time(session.connection(), f"alarms of {place.site or 'the service'}")
    return _completed(session, place)


def at_place(place: AlarmPlace) -> list[ColumnElement[bool]]:
    """Return the conditions that alarms are about a place. A motor may have moved to another relay."""
    if place.motor is not None:
        return [AlarmRow.motor == place.motor]
    return [
        _is(AlarmRow.ied, place.relay),
        AlarmRow.motor.is_(None),
        *([] if place.relay is not None else [_is(AlarmRow.site, place.site)]),
    ]


def _is(column: InstrumentedAttribute[str | None], value: str | None) -> ColumnElement[bool]:
    return column.is_(None) if value is None else column == value
