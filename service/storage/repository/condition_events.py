"""Events of motors: notes of people, and what the plant's files tell."""

import uuid

from sqlalchemy import select
from sqlalchemy.orm import Session

from core.condition.events import Event, EventKind
from service.storage.errors import NotFoundError, OutOfServiceError
from service.storage.models import ConditionEventRow, MotorRow
from service.storage.records import ConditionEvent, Cursor, Page
from service.storage.repository.fold_marks import mark
from service.storage.repository.sessions import Order, Sessions, columns_of, found, page_of, record_of
from service.storage.texts import storable


class ConditionEventRows(Sessions):
    def add_event(self, motor: str, event: Event, *, by: str, now_ns: int) -> ConditionEvent:
        """Keep what somebody tells of a motor, and have its condition follow.

        Raises NotFoundError, OutOfServiceError.
        """
        with self._write() as session:
            if not found(session, MotorRow, motor, "motor", lock=True).in_service:
                raise OutOfServiceError("motor", motor)
            return record_of(ConditionEvent, keep_event(session, motor, event, by, now_ns))

    def event(self, motor: str, event_id: str) -> ConditionEvent:
        """Return one event of a motor. Raises NotFoundError."""
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            row = session.get(ConditionEventRow, event_id)
            if row is None or row.motor != motor:
                raise NotFoundError(f"note of motor {motor}", event_id)
            return record_of(ConditionEvent, row)

    def events(self, motor: str, *, limit: int, after: Cursor | None = None) -> Page[ConditionEvent]:
        """Return a page of a motor's events, latest first. Raises NotFoundError."""
        query = select(*columns_of(ConditionEvent, ConditionEventRow)).where(ConditionEventRow.motor == motor)
        order: Order = [ConditionEventRow.time_ns, ConditionEventRow.id]
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return page_of(session, query, order, ConditionEvent, limit=limit, after=after, descending=True)


def keep_event(session: Session, motor: str, event: Event, by: str, now_ns: int) -> ConditionEventRow:
    """Add an event of a motor that is locked, and have its condition follow."""
    row = ConditionEventRow(
        id=str(uuid.uuid4()),
        motor=motor,
        time_ns=event.time_ns,
        kind=event.kind,
        reason=storable(event.reason),
        by=storable(by),
        made_ns=now_ns,
    )
    session.add(row)
    session.flush()
    if event.kind is not EventKind.NOTE:
        mark(session, motor, event.time_ns)
    return row
