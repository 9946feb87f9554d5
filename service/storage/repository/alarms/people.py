"""What people do about alarms. A step that is not possible is refused with what is."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime

from sqlalchemy import select
from sqlalchemy.orm import Session

from core.units import NANOSECONDS_PER_SECOND
from service.audit.actions import AuditAction
from service.storage.errors import AlarmActionError, AlarmCannotGrowError, NotFoundError
from service.storage.models import AlarmRow
from service.storage.records import Actor, Alarm
from service.storage.repository.alarms.changes import change, locked
from service.storage.repository.alarms.suppression import suppress_by_design
from service.storage.repository.audit.entries import note_change
from service.storage.repository.sessions import Sessions, columns_of, found, record_of
from service.storage.states import AlarmEvent, AlarmState

ACTIONS: Mapping[AlarmEvent, AuditAction] = {
    AlarmEvent.ACKNOWLEDGED: AuditAction.ALARM_ACKNOWLEDGED,
    AlarmEvent.ACKNOWLEDGEMENT_UNDONE: AuditAction.ALARM_ACKNOWLEDGEMENT_UNDONE,
    AlarmEvent.SHELVED: AuditAction.ALARM_SHELVED,
    AlarmEvent.UNSHELVED: AuditAction.ALARM_UNSHELVED,
    AlarmEvent.TAKEN_OUT_OF_SERVICE: AuditAction.ALARM_TAKEN_OUT_OF_SERVICE,
    AlarmEvent.PUT_BACK_IN_SERVICE: AuditAction.ALARM_PUT_BACK_IN_SERVICE,
}

SEEN = (AlarmEvent.ACKNOWLEDGED, AlarmEvent.SHELVED)
"""Who does this knows how bad the cause is now."""


@dataclass(frozen=True, slots=True)
class AcknowledgedAlarms:
    """What came of acknowledging several alarms, or of undoing that. refused: why, by their ids."""

    alarms: tuple[Alarm, ...]
    refused: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class _Deed:
    event: AlarmEvent
    by: Actor
    now_ns: int
    comment: str | None
    until: str | None = None


class AlarmPeopleRows(Sessions):
    def acknowledge_alarms(
        self, alarm_ids: Collection[str], *, by: Actor, now_ns: int, comment: str | None = None
    ) -> AcknowledgedAlarms:
        """Note that somebody has taken notice of alarms: of all for which that is possible."""
        deed = _Deed(AlarmEvent.ACKNOWLEDGED, by, now_ns, comment)
        refused = {one: str(NotFoundError("alarm", one)) for one in alarm_ids}
        done: list[Alarm] = []
        with self._write() as session:
            for row in locked(session, AlarmRow.id.in_(alarm_ids)):
                del refused[row.id]
                try:
                    _do(session, row, deed)
                except AlarmActionError as error:
                    refused[row.id] = str(error)
                else:
                    done.append(record_of(Alarm, row))
        return AcknowledgedAlarms(tuple(done), refused)

    def acknowledged_by(self, account: str, *, since_ns: int, limit: int) -> tuple[Alarm, ...]:
        """Return alarms that somebody has acknowledged since a time, and that are so still, latest first."""
        query = (
            select(*columns_of(Alarm, AlarmRow))
            .where(AlarmRow.state == AlarmState.ACKNOWLEDGED, AlarmRow.changed_by == account)
            .where(AlarmRow.changed_ns >= since_ns)
            .order_by(AlarmRow.changed_ns.desc(), AlarmRow.id)
            .limit(limit)
        )
        with self._read() as session:
            return tuple(Alarm(*row) for row in session.execute(query))

    def undo_acknowledgements(
        self, alarm_ids: Collection[str], *, by: Actor, since_ns: int, now_ns: int
    ) -> AcknowledgedAlarms:
        """Have alarms call again that the same person has acknowledged since a time, if they are so still."""
        deed = _Deed(AlarmEvent.ACKNOWLEDGEMENT_UNDONE, by, now_ns, None)
        refused = {one: str(NotFoundError("alarm", one)) for one in alarm_ids}
        done: list[Alarm] = []
        with self._write() as session:
            for row in locked(session, AlarmRow.id.in_(alarm_ids)):
                refused[row.id] = (
                    f"alarm {row.id} was not acknowledged by {by.name} in the last minutes: "
                    f"it is {row.state.value}, by {row.changed_by}"
                )
                is_own = row.changed_by == by.name and row.changed_ns >= since_ns
                if row.state is AlarmState.ACKNOWLEDGED and is_own:
                    _do(session, row, deed)
                    del refused[row.id]
                    done.append(record_of(Alarm, row))
        return AcknowledgedAlarms(tuple(done), refused)

    def acknowledge_alarm(
        self, alarm_id: str, *, by: Actor, now_ns: int, comment: str | None = None
    ) -> Alarm:
        """Note that somebody has taken notice of an alarm. Raises NotFoundError, AlarmActionError."""
        return self._do(alarm_id, _Deed(AlarmEvent.ACKNOWLEDGED, by, now_ns, comment))

    def shelve_alarm(
        self,
        alarm_id: str,
        *,
        by: Actor,
        now_ns: int,
        until_ns: int | None = None,
        growth: float | None = None,
        comment: str | None = None,
    ) -> Alarm:
        """Set an alarm aside until a time, until its value has grown by so much, or what comes first.

        Raises NotFoundError, AlarmActionError, AlarmCannotGrowError, ValueError (neither of both is given).
        """
        if until_ns is None and growth is None:
            raise ValueError("expected an end of the shelving: a time, or by how much the alarm may grow")
        with self._write() as session:
            row = found(session, AlarmRow, alarm_id, "alarm", lock=True)
            if growth is not None and row.value is None:
                raise AlarmCannotGrowError(alarm_id, row.kind)
            above = None if growth is None or row.value is None else row.value + growth
            deed = _Deed(AlarmEvent.SHELVED, by, now_ns, comment, _end(until_ns, above))
            before = _audited(row)
            _change(session, row, deed)
            row.shelved_until_ns, row.shelved_above = until_ns, above
            _audit(session, row, before, deed)
            return record_of(Alarm, row)

    def unshelve_alarm(self, alarm_id: str, *, by: Actor, now_ns: int, comment: str | None = None) -> Alarm:
        """End the shelving of an alarm: it calls again if its cause stands.

        Raises NotFoundError, AlarmActionError.
        """
        return self._do(alarm_id, _Deed(AlarmEvent.UNSHELVED, by, now_ns, comment))

    def take_alarm_out_of_service(
        self, alarm_id: str, *, by: Actor, now_ns: int, comment: str | None = None
    ) -> Alarm:
        """Set an alarm aside until somebody puts it back. Raises NotFoundError, AlarmActionError."""
        return self._do(alarm_id, _Deed(AlarmEvent.TAKEN_OUT_OF_SERVICE, by, now_ns, comment))

    def put_alarm_back_in_service(
        self, alarm_id: str, *, by: Actor, now_ns: int, comment: str | None = None
    ) -> Alarm:
        """Have an alarm call again, if its cause stands. Raises NotFoundError, AlarmActionError."""
        return self._do(alarm_id, _Deed(AlarmEvent.PUT_BACK_IN_SERVICE, by, now_ns, comment))

    def _do(self, alarm_id: str, deed: _Deed) -> Alarm:
        with self._write() as session:
            row = found(session, AlarmRow, alarm_id, "alarm", lock=True)
            _do(session, row, deed)
            return record_of(Alarm, row)


def _do(session: Session, row: AlarmRow, deed: _Deed) -> None:
    before = _audited(row)
    _change(session, row, deed)
    _audit(session, row, before, deed)


def _change(session: Session, row: AlarmRow, deed: _Deed) -> None:
    name = deed.by.name
    change(session, row, deed.event, now_ns=deed.now_ns, by=name, comment=deed.comment, until=deed.until)
    if deed.event in SEEN:
        row.seen_value = row.value
    suppress_by_design(session, row, now_ns=deed.now_ns)


def _end(until_ns: int | None, above: float | None) -> str:
    """Return the end of a shelving in words."""
    ends = []
    if until_ns is not None:
        ends.append(
            f"{datetime.fromtimestamp(until_ns // NANOSECONDS_PER_SECOND, UTC):%Y-%m-%d %H:%M:%S UTC}"
        )
    if above is not None:
        ends.append(f"its level is above {above:.2%}".replace("%", " %"))
    return f"until {' or '.join(ends)}"


def _audited(row: AlarmRow) -> dict[str, object]:
    """Return what of an alarm people may change."""
    return {
        "state": row.state,
        "comment": row.comment,
        "shelved_until_ns": row.shelved_until_ns,
        "shelved_above": row.shelved_above,
    }


def _audit(session: Session, row: AlarmRow, before: Mapping[str, object], deed: _Deed) -> None:
    after = _audited(row) | {"comment": deed.comment}
    note_change(
        session,
        deed.by,
        ACTIONS[deed.event],
        ("alarm", row.id),
        now_ns=deed.now_ns,
        before=before,
        after=after,
    )
