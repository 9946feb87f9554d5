"""What recordings show of the supply: kept with their diagnosis, and listed."""

from collections.abc import Sequence
from dataclasses import fields
from typing import Any, Final

from sqlalchemy import Select, case, delete, func, select
from sqlalchemy.orm import Session, aliased

from core.supply.figures import SupplyFigures
from service.storage.models import MotorRow, SupplyFiguresRow
from service.storage.records import Cursor, Page, RecordsBeyond, SupplyEntry, SupplyQuantity, UnbalanceEntry
from service.storage.repository.sessions import Order, Sessions, columns_of, found, latest_of, page_of, within
from service.storage.texts import storable

_ENTRY: Final = (SupplyFiguresRow.recording_id, SupplyFiguresRow.motor, SupplyFiguresRow.time_ns)
_FIGURES: Final = columns_of(SupplyFigures, SupplyFiguresRow)
_ORDER: Final[Order] = (SupplyFiguresRow.time_ns, SupplyFiguresRow.recording_id)


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
        query = _of_motor(motor).where(*within(SupplyFiguresRow.time_ns, from_ns, to_ns))
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return page_of(session, query, _ORDER, _entry, limit=limit, after=after)

    def latest_supply(self, motor: str, *, limit: int) -> tuple[SupplyEntry, ...]:
        """Return what a motor's latest recordings show of its supply, oldest first."""
        with self._read() as session:
            return latest_of(session, _of_motor(motor), _ORDER, _entry, limit=limit)

    def latest_unbalances(self) -> tuple[UnbalanceEntry, ...]:
        """Return the unbalance of the latest recording of each motor in service that tells it."""
        figures = aliased(SupplyFiguresRow)
        latest = (
            select(figures.recording_id)
            .where(figures.motor == MotorRow.name)
            .order_by(figures.time_ns.desc(), figures.recording_id.desc())
            .limit(1)
            .scalar_subquery()
        )
        query = (
            select(*columns_of(UnbalanceEntry, SupplyFiguresRow))
            .select_from(MotorRow)
            .join(SupplyFiguresRow, SupplyFiguresRow.recording_id == latest)
            .where(MotorRow.in_service)
        )
        with self._read() as session:
            return tuple(UnbalanceEntry(*row) for row in session.execute(query))

    def supply_beyond(
        self,
        motor: str,
        quantities: Sequence[tuple[SupplyQuantity, float]],
        *,
        from_ns: int,
        to_ns: int,
    ) -> tuple[RecordsBeyond, ...]:
        """Return how many of a motor's records have each quantity above its limit, from_ns <= time < to_ns.

        Raises NotFoundError.
        """
        told: list[Any] = [func.count()]
        for quantity, limit in quantities:
            column = getattr(SupplyFiguresRow, quantity.value)
            told += [func.sum(case((column > limit, 1), else_=0)), func.max(column)]
        query = select(*told).where(
            SupplyFiguresRow.motor == motor, *within(SupplyFiguresRow.time_ns, from_ns, to_ns)
        )
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            records, *figures = session.execute(query).one()
        pairs = zip(figures[::2], figures[1::2], strict=True)
        return tuple(RecordsBeyond(records, int(beyond or 0), worst) for beyond, worst in pairs)


def keep_supply(
    session: Session,
    recording_id: str,
    motor: str,
    time_ns: int,
    figures: SupplyFigures | None,
    *,
    is_first: bool = False,
) -> None:
    """Keep what a recording shows of the supply, in place of what an earlier diagnosis found.

    is_first: there was no earlier diagnosis.
    """
    if not is_first:
        forget_supply(session, recording_id)
    if figures is None:
        return
    values = {field.name: getattr(figures, field.name) for field in fields(figures)}
    values["reasons"] = tuple(map(storable, figures.reasons))
    session.add(SupplyFiguresRow(recording_id=recording_id, motor=motor, time_ns=time_ns, **values))


def forget_supply(session: Session, recording_id: str) -> None:
    """Delete what a recording showed of the supply."""
    session.execute(delete(SupplyFiguresRow).where(SupplyFiguresRow.recording_id == recording_id))


def latest_figures(session: Session, motor: str, limit: int) -> tuple[SupplyFigures, ...]:
    """Return what a motor's latest recordings show of its supply, oldest first."""
    return tuple(one.figures for one in latest_of(session, _of_motor(motor), _ORDER, _entry, limit=limit))


def _of_motor(motor: str) -> Select[*tuple[Any, ...]]:
    return select(*_ENTRY, *_FIGURES).where(SupplyFiguresRow.motor == motor)


def _entry(recording_id: str, motor: str, time_ns: int, *figures: Any) -> SupplyEntry:
    named: dict[str, Any] = dict(zip((field.name for field in fields(SupplyFigures)), figures, strict=True))
    return SupplyEntry(recording_id, motor, time_ns, SupplyFigures(**named))
