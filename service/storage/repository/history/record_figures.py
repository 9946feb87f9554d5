"""What recordings show of air gap, load, supply and losses: kept with their diagnosis, and listed."""

from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import Any, Final, TypeVar

from sqlalchemy import Select, case, delete, func, select
from sqlalchemy.orm import Session, aliased

from core.losses.figures import LossFigures
from core.quantities import Subject, of_subject
from core.rotor.swing_findings import EccentricityFinding, PulsationFinding
from core.supply.figures import SupplyFigures
from service.storage.models import DETAILS, MotorRow, RecordFiguresRow, details_of
from service.storage.records import (
    Cursor,
    LossEntry,
    Page,
    RecordsBeyond,
    SupplyEntry,
    SupplyQuantity,
    SwingEntry,
    UnbalanceEntry,
)
from service.storage.repository.sessions import Order, Sessions, columns_of, found, latest_of, page_of, within
from service.storage.texts import storable

Finding = TypeVar("Finding", EccentricityFinding, PulsationFinding, SupplyFigures, LossFigures)

_PLACE: Final = (RecordFiguresRow.recording_id, RecordFiguresRow.motor, RecordFiguresRow.time_ns)
_ORDER: Final[Order] = (RecordFiguresRow.time_ns, RecordFiguresRow.recording_id)


def _columns(subject: Subject) -> tuple[Any, ...]:
    """Return the columns of a subject: its figures in the order of the catalogue, and its details."""
    return (*(getattr(RecordFiguresRow, one.name) for one in of_subject(subject)), details_of(subject))


_SUPPLY: Final = _columns(Subject.SUPPLY)
_AIR_GAP: Final = _columns(Subject.AIR_GAP)
_LOSSES: Final = _columns(Subject.LOSSES)
_LOAD: Final = _columns(Subject.LOAD)


class RecordFigureRows(Sessions):
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
        query = _supplies(motor).where(*within(RecordFiguresRow.time_ns, from_ns, to_ns))
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return page_of(session, query, _ORDER, _supply_entry, limit=limit, after=after)

    def latest_supply(self, motor: str, *, limit: int) -> tuple[SupplyEntry, ...]:
        """Return what a motor's latest recordings show of its supply, oldest first."""
        with self._read() as session:
            return latest_of(session, _supplies(motor), _ORDER, _supply_entry, limit=limit)

    def swing_trend(
        self,
        motor: str,
        *,
        limit: int,
        from_ns: int | None = None,
        to_ns: int | None = None,
        after: Cursor | None = None,
    ) -> Page[SwingEntry]:
        """Return what a motor's recordings show of air gap and swings, oldest first, from_ns <= time < to_ns.

        Raises NotFoundError.
        """
        query = _swings(motor).where(*within(RecordFiguresRow.time_ns, from_ns, to_ns))
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return page_of(session, query, _ORDER, _swing_entry, limit=limit, after=after)

    def latest_swings(self, motor: str, *, limit: int) -> tuple[SwingEntry, ...]:
        """Return what a motor's latest recordings show of its air gap and its load, oldest first."""
        with self._read() as session:
            return latest_of(session, _swings(motor), _ORDER, _swing_entry, limit=limit)

    def latest_losses(self, motor: str, *, limit: int) -> tuple[LossEntry, ...]:
        """Return what a motor's latest recordings tell of its losses, oldest first. Raises NotFoundError."""
        tells = (RecordFiguresRow.motor == motor, details_of(Subject.SUPPLY).is_not(None))
        query = select(*_PLACE, *_LOSSES).where(*tells)
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return latest_of(session, query, _ORDER, _loss_entry, limit=limit)

    def latest_unbalances(self) -> tuple[UnbalanceEntry, ...]:
        """Return the unbalance of the latest recording of each motor in service that tells it."""
        figures = aliased(RecordFiguresRow)
        latest = (
            select(figures.recording_id)
            .where(figures.motor == MotorRow.name, getattr(figures, DETAILS[Subject.SUPPLY]).is_not(None))
            .order_by(figures.time_ns.desc(), figures.recording_id.desc())
            .limit(1)
            .scalar_subquery()
        )
        query = (
            select(*columns_of(UnbalanceEntry, RecordFiguresRow))
            .select_from(MotorRow)
            .join(RecordFiguresRow, RecordFiguresRow.recording_id == latest)
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
        counted: list[Any] = [func.count()]
        for quantity, limit in quantities:
            column = getattr(RecordFiguresRow, quantity.value)
            counted += [func.sum(case((column > limit, 1), else_=0)), func.max(column)]
        query = select(*counted).where(
            RecordFiguresRow.motor == motor,
            details_of(Subject.SUPPLY).is_not(None),
            *within(RecordFiguresRow.time_ns, from_ns, to_ns),
        )
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            records, *figures = session.execute(query).one()
        pairs = zip(figures[::2], figures[1::2], strict=True)
        return tuple(RecordsBeyond(records, int(beyond or 0), worst) for beyond, worst in pairs)


def keep_record_figures(
    session: Session,
    recording_id: str,
    motor: str,
    time_ns: int,
    found: Mapping[Subject, object],
    *,
    is_first: bool = False,
) -> None:
    """Keep what a recording shows, in place of what an earlier diagnosis found.

    found: by subject, as dataclasses.  is_first: there was no earlier diagnosis.
    """
    if not is_first:
        forget_record_figures(session, recording_id)
    values = {name: value for subject, one in found.items() for name, value in _values(subject, one).items()}
    if values:
        session.add(RecordFiguresRow(recording_id=recording_id, motor=motor, time_ns=time_ns, **values))


def forget_record_figures(session: Session, recording_id: str) -> None:
    """Delete what a recording showed."""
    session.execute(delete(RecordFiguresRow).where(RecordFiguresRow.recording_id == recording_id))


def latest_figures(
    session: Session, motor: str, limit: int
) -> tuple[tuple[SupplyFigures, ...], tuple[LossFigures, ...]]:
    """Return what a motor's latest recordings show of its supply and of its losses, oldest first."""
    tells = (RecordFiguresRow.motor == motor, details_of(Subject.SUPPLY).is_not(None))
    query = select(*_PLACE, *_SUPPLY, *_LOSSES).where(*tells)
    entries = latest_of(session, query, _ORDER, lambda *row: row[len(_PLACE) :], limit=limit)
    supplies = (_finding(SupplyFigures, Subject.SUPPLY, one[: len(_SUPPLY)]) for one in entries)
    losses = (_finding(LossFigures, Subject.LOSSES, one[len(_SUPPLY) :]) for one in entries)
    return tuple(supplies), tuple(losses)


def _values(subject: Subject, finding: Any) -> dict[str, object]:
    """Return the columns of a finding."""
    quantities = of_subject(subject)
    in_columns = {one.attribute if one.end is None else one.end[0] for one in quantities}
    others = {
        field.name: getattr(finding, field.name) for field in fields(finding) if field.name not in in_columns
    }
    others["reasons"] = tuple(map(storable, finding.reasons))
    return {one.name: one.read(finding) for one in quantities} | {DETAILS[subject]: others}


def _finding(kind: type[Finding], subject: Subject, values: Sequence[Any]) -> Finding:
    """Return a finding from its columns."""
    *figures, details = values
    named: dict[str, Any] = {
        name: tuple(value) if isinstance(value, list) else value for name, value in details.items()
    }
    for one, value in zip(of_subject(subject), figures, strict=True):
        if one.end is None:
            named[one.attribute] = value
        else:
            ends: tuple[float, ...] = named.get(one.end[0]) or ()
            named[one.end[0]] = None if value is None else (*ends, value)
    return kind(**named)


def _supplies(motor: str) -> Select[*tuple[Any, ...]]:
    tells = (RecordFiguresRow.motor == motor, details_of(Subject.SUPPLY).is_not(None))
    return select(*_PLACE, *_SUPPLY).where(*tells)


def _swings(motor: str) -> Select[*tuple[Any, ...]]:
    tells = (RecordFiguresRow.motor == motor, details_of(Subject.AIR_GAP).is_not(None))
    return select(*_PLACE, *_AIR_GAP, *_LOAD).where(*tells)


def _supply_entry(recording_id: str, motor: str, time_ns: int, *values: Any) -> SupplyEntry:
    return SupplyEntry(recording_id, motor, time_ns, _finding(SupplyFigures, Subject.SUPPLY, values))


def _loss_entry(recording_id: str, motor: str, time_ns: int, *values: Any) -> LossEntry:
    return LossEntry(recording_id, motor, time_ns, _finding(LossFigures, Subject.LOSSES, values))


def _swing_entry(recording_id: str, motor: str, time_ns: int, *values: Any) -> SwingEntry:
    of_gap, of_load = values[: len(_AIR_GAP)], values[len(_AIR_GAP) :]
    return SwingEntry(
        recording_id,
        motor,
        time_ns,
        _finding(EccentricityFinding, Subject.AIR_GAP, of_gap),
        _finding(PulsationFinding, Subject.LOAD, of_load),
    )
