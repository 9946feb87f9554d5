"""When motors and sites stop next, as people planned."""

from typing import Final

from sqlalchemy.orm import Session

from core.time_stamps import rfc3339
from service.audit.actions import AuditAction
from service.storage.errors import OutOfServiceError
from service.storage.models import MotorRow, SiteRow
from service.storage.records import PlannedStop, StopOf
from service.storage.records.actors import Actor
from service.storage.repository.audit.entries import note_change
from service.storage.repository.sessions import Sessions, found

TABLES: Final[dict[StopOf, type[MotorRow | SiteRow]]] = {StopOf.MOTOR: MotorRow, StopOf.SITE: SiteRow}


class PlannedStopRows(Sessions):
    def plan_stop(self, of: StopOf, name: str, time_ns: int | None, *, by: Actor, now_ns: int) -> None:
        """Keep when a motor or a site stops next; None: it has no plan any more.

        Raises NotFoundError, OutOfServiceError.
        """
        with self._write() as session:
            row = found(session, TABLES[of], name, of.value, lock=True)
            if not row.in_service:
                raise OutOfServiceError(of.value, name)
            before, row.planned_stop_ns = row.planned_stop_ns, time_ns
            action = AuditAction.STOP_CANCELLED if time_ns is None else AuditAction.STOP_PLANNED
            note_change(
                session,
                by,
                action,
                (of.value, name),
                now_ns=now_ns,
                before=_kept(before),
                after=_kept(time_ns),
            )

    def planned_stop_of_site(self, site: str, *, now_ns: int) -> PlannedStop | None:
        """Return the stop that is planned of a whole site; None where none is ahead. Raises NotFoundError."""
        with self._read() as session:
            return _ahead(found(session, SiteRow, site, "site"), StopOf.SITE, now_ns)

    def planned_stop(self, motor: str, *, now_ns: int) -> PlannedStop | None:
        """Return the next stop of a motor: its own, or that of its site where it is earlier.

        None where none is ahead. Raises NotFoundError.
        """
        with self._read() as session:
            row = found(session, MotorRow, motor, "motor")
            planned = (_ahead(row, StopOf.MOTOR, now_ns), _of_site(session, row.site, now_ns))
        return min((one for one in planned if one is not None), key=lambda one: one.time_ns, default=None)


def _of_site(session: Session, site: str, now_ns: int) -> PlannedStop | None:
    row = session.get(SiteRow, site)
    return None if row is None else _ahead(row, StopOf.SITE, now_ns)


def _ahead(row: MotorRow | SiteRow, of: StopOf, now_ns: int) -> PlannedStop | None:
    """Return the stop of a row that is still ahead."""
    time_ns = row.planned_stop_ns
    return None if time_ns is None or time_ns <= now_ns else PlannedStop(time_ns, of)


def _kept(time_ns: int | None) -> dict[str, object] | None:
    return None if time_ns is None else {"time": rfc3339(time_ns)}
