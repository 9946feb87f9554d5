"""What recordings show of the supply: kept with their diagnosis, and listed."""

from dataclasses import fields
from typing import Any, Final

from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from core.supply.figures import SupplyFigures
from service.storage.models import MotorRow, SupplyFiguresRow
from service.storage.records import Cursor, Page, SupplyEntry
from service.storage.repository.sessions import Order, Sessions, columns_of, found, page_of
from service.storage.texts import storable

_ENTRY: Final = (SupplyFiguresRow.recording_id, SupplyFiguresRow.motor, SupplyFiguresRow.time_ns)
_FIGURES: Final = columns_of(SupplyFigures, SupplyFiguresRow)


class SupplyRows(Sessions):
    def supply_trend(
        self,
        motor: str,
        *,
        limit: int,
        from_ns: int | None = None,
        to_ns: int | None = None,
        after: Cursor | None = None,
    ) -> Page[SupplyEntry]:
        """Return what a motor's recordings show of its supply, oldest first, from_ns <= time < to_ns.

        Raises NotFoundError.
        """
        query = select(*_ENTRY, *_FIGURES).where(SupplyFiguresRow.motor == motor)
        if from_ns is not None:
            query = query.where(SupplyFiguresRow.time_ns >= from_ns)
        if to_ns is not None:
            query = query.where(SupplyFiguresRow.time_ns < to_ns)
        order: Order = [SupplyFiguresRow.time_ns, SupplyFiguresRow.recording_id]
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return page_of(session, query, order, _entry, limit=limit, after=after)

    def latest_supply(self, motor: str, *, limit: int) -> tuple[SupplyEntry, ...]:
        """Return what a motor's latest recordings show of its supply, oldest first."""
        query = (
            select(*_ENTRY, *_FIGURES)
            .where(SupplyFiguresRow.motor == motor)
            .order_by(SupplyFiguresRow.time_ns.desc(), SupplyFiguresRow.recording_id.desc())
            .limit(limit)
        )
        with self._read() as session:
            return tuple(_entry(*row) for row in reversed(session.execute(query).all()))


def keep_supply(
    session: Session, recording_id: str, motor: str, time_ns: int, figures: SupplyFigures | None
) -> None:
    """Keep what a recording shows of the supply, in place of what an earlier diagnosis found."""
    forget_supply(session, recording_id)
    if figures is None:
        return
    values = {field.name: getattr(figures, field.name) for field in fields(figures)}
    values["reasons"] = tuple(map(storable, figures.reasons))
    session.add(SupplyFiguresRow(recording_id=recording_id, motor=motor, time_ns=time_ns, **values))


def forget_supply(session: Session, recording_id: str) -> None:
    """Delete what a recording showed of the supply."""
    session.execute(delete(SupplyFiguresRow).where(SupplyFiguresRow.recording_id == recording_id))


def _entry(recording_id: str, motor: str, time_ns: int, *figures: Any) -> SupplyEntry:
    named: dict[str, Any] = dict(zip((field.name for field in fields(SupplyFigures)), figures, strict=True))
    return SupplyEntry(recording_id, motor, time_ns, SupplyFigures(**named))
