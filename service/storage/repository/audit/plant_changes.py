"""What the plant's files change at a start of the service, for the audit trail."""

from collections.abc import Mapping
from typing import Final

from sqlalchemy import select
from sqlalchemy.orm import Session

from service.audit.actions import AuditAction
from service.storage.models import Base, IedRow, MotorRow, SiteRow
from service.storage.records.actors import Actor
from service.storage.repository.audit.entries import note_change
from service.storage.repository.audit.values import changed

InService = Mapping[tuple[str, str], Mapping[str, object]]
"""What is told of each site, relay and motor, by kind and name."""

TOLD: Final[Mapping[str, tuple[type[Base], tuple[str, ...]]]] = {
    "site": (SiteRow, ("description",)),
    "relay": (IedRow, ("site", "host", "port", "manufacturer", "type")),
    "motor": (MotorRow, ("description", "site", "ied", "schedule", "bus", "parameters_source")),
}


def plant_in_service(session: Session) -> InService:
    """Return what the tables say of the plant that is in service."""
    return {
        (kind, row.name): dict(zip(columns, row[1:], strict=True))
        for kind, (table, columns) in TOLD.items()
        for row in session.execute(
            select(*(table.__table__.c[name] for name in ("name", *columns))).where(
                table.__table__.c.in_service
            )
        )
    }


def note_plant_changes(session: Session, before: InService, by: Actor, *, now_ns: int) -> None:
    """Note each site, relay and motor that came, left or is told otherwise than before."""
    after = plant_in_service(session)
    for subject in sorted({*before, *after}):
        was, now = before.get(subject), after.get(subject)
        if was is not None and now is not None:
            was, now = changed(was, now)
        if was or now:
            action = AuditAction.PLANT_CHANGED
            note_change(session, by, action, subject, now_ns=now_ns, before=was, after=now)
