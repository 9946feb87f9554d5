"""Events of motors: notes of people, and what the plant's files tell."""

import uuid

from sqlalchemy import select
from sqlalchemy.orm import Session

from core.condition.events import Event, EventKind
from core.time_stamps import rfc3339
from service.audit.actions import AuditAction
from service.storage.errors import (
    NotFoundError,
    OutOfServiceError,
    StateConflictError,
    TooManyNotesError,
)
from service.storage.models import ConditionEventRow, MotorRow
from service.storage.records import ConditionEvent, Cursor, Page
from service.storage.records.actors import Actor
from service.storage.repository.alarms.starts import settle_start_alarms
from service.storage.repository.audit.entries import note_change
from service.storage.repository.conditions.fold_marks import mark
from service.storage.repository.history.start_reference import RENEWING
from service.storage.repository.motor_versions import MOTORS_FILE
from service.storage.repository.sessions import (
    Order,
    Sessions,
    columns_of,
    found,
    has_as_many,
    page_of,
    record_of,
)
from service.storage.texts import storable


class ConditionEventRows(Sessions):
    def add_event(
        self,
        motor: str,
        event: Event,
        *,
        by: Actor,
        on_behalf_of: str | None = None,
        now_ns: int,
        most_notes: int | None = None,
    ) -> ConditionEvent:
        """Keep what somebody tells of a motor, and have its condition follow.

        on_behalf_of: whom they name as who says so. most_notes: so many notes the motor may have, those that
        baselines leave counted; None: any number. Raises NotFoundError, OutOfServiceError,
        TooManyNotesError.
        """
        with self._write() as session:
            place = found(session, MotorRow, motor, "motor", lock=True)
            if not place.in_service:
                raise OutOfServiceError("motor", motor)
            told = select(ConditionEventRow.id).where(
                ConditionEventRow.motor == motor, ConditionEventRow.kind != EventKind.PARAMETERS_EDITED
            )
            if most_notes is not None and has_as_many(session, told, most_notes):
                raise TooManyNotesError(motor, most_notes)
            kept = keep_event(session, motor, event, by, now_ns, on_behalf_of=on_behalf_of)
            if event.kind in RENEWING:
                settle_start_alarms(session, place, now_ns=now_ns)
            is_restart = event.kind is EventKind.REFERENCE_RESTARTED
            action = AuditAction.REFERENCE_RESTARTED if is_restart else AuditAction.NOTE_ADDED
            note_change(session, by, action, ("motor", motor), now_ns=now_ns, after=_noted(kept))
            return record_of(ConditionEvent, kept)

    def withdraw_event(
        self,
        motor: str,
        event_id: str,
        *,
        by: Actor,
        on_behalf_of: str | None = None,
        reason: str,
        now_ns: int,
    ) -> ConditionEvent:
        """Let an event that was wrong count no more, as if nobody had told it; it is kept with the reason.

        on_behalf_of: whom they name as who says so. Raises NotFoundError, StateConflictError (it was
        withdrawn before, or is what the motors file tells).
        """
        with self._write() as session:
            place = found(session, MotorRow, motor, "motor", lock=True)
            row = _event(session, motor, event_id)
            # A person may be called as the file is, but tells of no edit.
            is_of_the_file = row.kind is EventKind.PARAMETERS_EDITED and row.by == MOTORS_FILE
            if row.withdrawn_ns is not None or is_of_the_file:
                present = "withdrawn" if row.withdrawn_ns is not None else "what the motors file tells"
                raise StateConflictError("note", event_id, present=present, wanted="withdrawn")
            row.withdrawn_ns, row.withdrawn_reason = now_ns, storable(reason)
            row.withdrawn_account, row.withdrawn_by = storable(by.name), storable(on_behalf_of or by.name)
            if row.kind is not EventKind.NOTE:
                mark(session, motor, row.time_ns)
            if row.kind in RENEWING:
                settle_start_alarms(session, place, now_ns=now_ns)
            after = {"reason": reason, "on_behalf_of": on_behalf_of}
            note_change(
                session,
                by,
                AuditAction.NOTE_WITHDRAWN,
                ("motor", motor),
                now_ns=now_ns,
                before=_noted(row),
                after=after,
            )
            return record_of(ConditionEvent, row)

    def event(self, motor: str, event_id: str) -> ConditionEvent:
        """Return one event of a motor. Raises NotFoundError."""
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return record_of(ConditionEvent, _event(session, motor, event_id))

    def events(self, motor: str, *, limit: int, after: Cursor | None = None) -> Page[ConditionEvent]:
        """Return a page of a motor's events, latest first. Raises NotFoundError."""
        query = select(*columns_of(ConditionEvent, ConditionEventRow)).where(ConditionEventRow.motor == motor)
        order: Order = [ConditionEventRow.time_ns, ConditionEventRow.id]
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return page_of(session, query, order, ConditionEvent, limit=limit, after=after, descending=True)


def keep_event(
    session: Session, motor: str, event: Event, by: Actor, now_ns: int, *, on_behalf_of: str | None = None
) -> ConditionEventRow:
    """Add an event of a motor that is locked, and have its condition follow."""
    row = ConditionEventRow(
        id=str(uuid.uuid4()),
        motor=motor,
        time_ns=event.time_ns,
        kind=event.kind,
        reason=storable(event.reason),
        account=storable(by.name),
        by=storable(on_behalf_of or by.name),
        made_ns=now_ns,
    )
    session.add(row)
    session.flush()
    if event.kind is not EventKind.NOTE:
        mark(session, motor, event.time_ns)
    return row


def _noted(row: ConditionEventRow) -> dict[str, object]:
    """Return what the audit trail keeps of an event."""
    return {
        "note": row.id,
        "kind": row.kind,
        "text": row.reason,
        "time": rfc3339(row.time_ns),
        "on_behalf_of": record_of(ConditionEvent, row).on_behalf_of,
    }


def _event(session: Session, motor: str, event_id: str) -> ConditionEventRow:
    row = session.get(ConditionEventRow, event_id)
    if row is None or row.motor != motor:
        raise NotFoundError(f"note of motor {motor}", event_id)
    return row
