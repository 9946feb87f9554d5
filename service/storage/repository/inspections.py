"""What people found when they inspected motors, and how often the service was right."""

import uuid
from collections import Counter
from collections.abc import Sequence
from typing import Any, Final

from sqlalchemy import Select, func, select
from sqlalchemy.orm import Session

from core.condition.kinds import Kind
from core.time_stamps import rfc3339
from service.audit.actions import AuditAction
from service.storage.errors import (
    NotFoundError,
    OutOfServiceError,
    StateConflictError,
    TooManyInspectionsError,
)
from service.storage.models import AlarmRow, InspectionPictureRow, InspectionRow, MotorRow
from service.storage.records import (
    Cursor,
    Inspection,
    InspectionCount,
    InspectionPicture,
    NewInspection,
    Page,
)
from service.storage.records.actors import Actor
from service.storage.repository.audit.entries import note_change
from service.storage.repository.sessions import Order, Sessions, found, has_as_many, page_of, rows_of
from service.storage.states import InspectionOutcome
from service.storage.texts import storable

MOST_INSPECTIONS: Final = 500
"""Of a motor."""
MOST_PICTURES: Final = 4
"""Of an inspection."""
MOST_PICTURES_OF_MOTOR: Final = 100
_FIELDS: Final = (
    *("id", "motor", "time_ns", "kind", "finding", "outcome", "cause", "text", "alarm_id", "account", "by"),
    *("made_ns", "withdrawn_ns", "withdrawn_account", "withdrawn_reason"),
)
_PICTURES: Final = (
    select(func.count())
    .select_from(InspectionPictureRow)
    .where(InspectionPictureRow.inspection == InspectionRow.id)
    .correlate(InspectionRow)
    .scalar_subquery()
)
_ORDER: Final[Order] = (InspectionRow.time_ns, InspectionRow.id)


class InspectionRows(Sessions):
    def add_inspection(
        self,
        motor: str,
        new: NewInspection,
        pictures: Sequence[InspectionPicture] = (),
        *,
        by: Actor,
        on_behalf_of: str | None = None,
        now_ns: int,
    ) -> Inspection:
        """Keep what an inspection found, with its pictures. The motor's condition stays as it is.

        Raises NotFoundError (also an alarm that is not the motor's), OutOfServiceError,
        TooManyInspectionsError.
        """
        with self._write() as session:
            place = found(session, MotorRow, motor, "motor", lock=True)
            if not place.in_service:
                raise OutOfServiceError("motor", motor)
            if new.alarm_id is not None:
                alarm = session.get(AlarmRow, new.alarm_id)
                if alarm is None or alarm.motor != motor:
                    raise NotFoundError(f"alarm of motor {motor}", new.alarm_id)
            kept = select(InspectionRow.id).where(InspectionRow.motor == motor)
            if has_as_many(session, kept, MOST_INSPECTIONS):
                raise TooManyInspectionsError(f"motor {motor}", MOST_INSPECTIONS, "inspections")
            row = InspectionRow(
                id=str(uuid.uuid4()),
                motor=motor,
                time_ns=new.time_ns,
                kind=new.kind,
                finding=storable(new.finding),
                outcome=new.outcome,
                cause=None if new.cause is None else storable(new.cause),
                text=storable(new.text),
                alarm_id=new.alarm_id,
                account=storable(by.name),
                by=storable(on_behalf_of or by.name),
                made_ns=now_ns,
            )
            session.add(row)
            session.flush()
            for picture in pictures:
                _keep(session, row, picture)
            after = {**_noted(row), "pictures": len(pictures), "on_behalf_of": on_behalf_of}
            note_change(
                session, by, AuditAction.INSPECTION_ADDED, ("motor", motor), now_ns=now_ns, after=after
            )
            return _one(session, row.id)

    def add_inspection_picture(
        self, motor: str, inspection_id: str, picture: InspectionPicture, *, by: Actor, now_ns: int
    ) -> Inspection:
        """Keep one more picture of an inspection.

        Raises NotFoundError, StateConflictError (it was withdrawn), TooManyInspectionsError.
        """
        with self._write() as session:
            found(session, MotorRow, motor, "motor", lock=True)
            row = _of_motor(session, motor, inspection_id)
            if row.withdrawn_ns is not None:
                raise StateConflictError("inspection", inspection_id, present="withdrawn", wanted="extended")
            number = _keep(session, row, picture)
            after = {"inspection": row.id, "picture": number, "size_bytes": len(picture.content)}
            note_change(
                session, by, AuditAction.INSPECTION_ADDED, ("motor", motor), now_ns=now_ns, after=after
            )
            return _one(session, row.id)

    def withdraw_inspection(
        self, motor: str, inspection_id: str, *, by: Actor, reason: str, now_ns: int
    ) -> Inspection:
        """Let an inspection count no more; it is kept with the reason.

        Raises NotFoundError, StateConflictError (it was withdrawn before).
        """
        with self._write() as session:
            found(session, MotorRow, motor, "motor", lock=True)
            row = _of_motor(session, motor, inspection_id)
            if row.withdrawn_ns is not None:
                raise StateConflictError("inspection", inspection_id, present="withdrawn", wanted="withdrawn")
            row.withdrawn_ns, row.withdrawn_account = now_ns, storable(by.name)
            row.withdrawn_reason = storable(reason)
            note_change(
                session,
                by,
                AuditAction.INSPECTION_WITHDRAWN,
                ("motor", motor),
                now_ns=now_ns,
                before=_noted(row),
                after={"reason": reason},
            )
            session.flush()
            return _one(session, row.id)

    def inspections(
        self, motor: str | None = None, *, limit: int, after: Cursor | None = None
    ) -> Page[Inspection]:
        """Return the inspections of a motor, or of all, latest first. Raises NotFoundError."""
        query = _selected()
        with self._read() as session:
            if motor is not None:
                found(session, MotorRow, motor, "motor")
                query = query.where(InspectionRow.motor == motor)
            return page_of(session, query, _ORDER, Inspection, limit=limit, after=after, descending=True)

    def inspection(self, motor: str, inspection_id: str) -> Inspection:
        """Return one inspection of a motor. Raises NotFoundError."""
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            _of_motor(session, motor, inspection_id)
            return _one(session, inspection_id)

    def inspection_picture(self, motor: str, inspection_id: str, number: int) -> InspectionPicture:
        """Return one picture of an inspection. Raises NotFoundError."""
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            _of_motor(session, motor, inspection_id)
            row = session.get(InspectionPictureRow, (inspection_id, number))
            if row is None:
                raise NotFoundError(f"picture of inspection {inspection_id}", str(number))
            return InspectionPicture(row.media_type, row.content)

    def inspection_counts(self) -> tuple[InspectionCount, ...]:
        """Return how often inspections found what was said: by kind of finding, site and year, latest first.

        Inspections that were withdrawn do not count.
        """
        query = (
            select(InspectionRow.kind, MotorRow.site, InspectionRow.time_ns, InspectionRow.outcome)
            .join(MotorRow, MotorRow.name == InspectionRow.motor)
            .where(InspectionRow.withdrawn_ns.is_(None))
        )
        with self._read() as session:
            rows = rows_of(session, query)
        numbers: Counter[tuple[Kind, str, int, InspectionOutcome]] = Counter(
            (kind, site, int(rfc3339(time_ns)[:4]), outcome) for kind, site, time_ns, outcome in rows
        )
        places = {(-year, site, kind) for kind, site, year, _ in numbers}
        return tuple(
            InspectionCount(
                kind,
                site,
                -year,
                *(numbers[kind, site, -year, outcome] for outcome in InspectionOutcome),
            )
            for year, site, kind in sorted(places)
        )


def _selected() -> Select[*tuple[Any, ...]]:
    return select(*(getattr(InspectionRow, name) for name in _FIELDS), _PICTURES)


def _one(session: Session, inspection_id: str) -> Inspection:
    (row,) = rows_of(session, _selected().where(InspectionRow.id == inspection_id))
    return Inspection(*row)


def _of_motor(session: Session, motor: str, inspection_id: str) -> InspectionRow:
    row = session.get(InspectionRow, inspection_id)
    if row is None or row.motor != motor:
        raise NotFoundError(f"inspection of motor {motor}", inspection_id)
    return row


def _keep(session: Session, row: InspectionRow, picture: InspectionPicture) -> int:
    """Add a picture, and return its number. Raises TooManyInspectionsError."""
    of_motor = select(InspectionPictureRow.inspection).where(InspectionPictureRow.motor == row.motor)
    if has_as_many(session, of_motor, MOST_PICTURES_OF_MOTOR):
        raise TooManyInspectionsError(f"motor {row.motor}", MOST_PICTURES_OF_MOTOR, "pictures")
    number = _one(session, row.id).pictures + 1
    if number > MOST_PICTURES:
        raise TooManyInspectionsError(f"inspection {row.id}", MOST_PICTURES, "pictures")
    session.add(
        InspectionPictureRow(
            inspection=row.id,
            number=number,
            motor=row.motor,
            media_type=picture.media_type,
            size_bytes=len(picture.content),
            content=picture.content,
        )
    )
    session.flush()
    return number


def _noted(row: InspectionRow) -> dict[str, object]:
    """Return what the audit trail keeps of an inspection."""
    return {
        "inspection": row.id,
        "time": rfc3339(row.time_ns),
        "kind": row.kind,
        "outcome": row.outcome,
        "cause": row.cause,
        "text": row.text,
    }
