"""What recordings show of the rotor: kept with their diagnosis, and listed."""

from dataclasses import fields
from typing import Any, Final

from sqlalchemy import Select, delete, select
from sqlalchemy.orm import Session

from core.rotor.finding import RotorFinding
from core.rotor.trend import DatedFinding, RotorCondition, rotor_condition
from service.storage.models import MotorRow, RotorFindingRow
from service.storage.records import Cursor, Page, RotorEntry
from service.storage.repository.sessions import Order, Sessions, found, latest_of, page_of, within
from service.storage.texts import storable

_INTERVAL: Final = "severity_dB_ci95"
_FIGURES: Final = tuple(field.name for field in fields(RotorFinding) if field.name != _INTERVAL)
"""Columns that are called as the fields of a RotorFinding are."""

_ENDS: Final = (f"{_INTERVAL}_low", f"{_INTERVAL}_high")
_COLUMNS: Final = [
    getattr(RotorFindingRow, name) for name in ("recording_id", "motor", "time_ns", *_FIGURES, *_ENDS)
]
_ORDER: Final[Order] = (RotorFindingRow.time_ns, RotorFindingRow.recording_id)

MOST_OF_EACH_END: Final = 500
"""So many of a motor's first findings, which its baselines follow from, and of its latest ones are judged."""


class RotorRows(Sessions):
    def rotor_condition(self, motor: str) -> RotorCondition:
        """Return what a motor's recordings say of its rotor together. Raises NotFoundError."""
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return rotor_condition_of(session, motor)

    def rotor_trend(
        self,
        motor: str,
        *,
        limit: int,
        from_ns: int | None = None,
        to_ns: int | None = None,
        after: Cursor | None = None,
    ) -> Page[RotorEntry]:
        """Return what a motor's recordings show of its rotor, oldest first, from_ns <= time < to_ns.

        Raises NotFoundError.
        """
        query = _of_motor(motor).where(*within(RotorFindingRow.time_ns, from_ns, to_ns))
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return page_of(session, query, _ORDER, _entry, limit=limit, after=after)

    def latest_rotor_findings(self, motor: str, *, limit: int) -> tuple[RotorEntry, ...]:
        """Return what a motor's latest recordings show of its rotor, oldest first. Raises NotFoundError."""
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return latest_findings(session, motor, limit)


def latest_findings(session: Session, motor: str, limit: int) -> tuple[RotorEntry, ...]:
    """Return what a motor's latest recordings show of its rotor, oldest first."""
    return latest_of(session, _of_motor(motor), _ORDER, _entry, limit=limit)


def rotor_condition_of(session: Session, motor: str) -> RotorCondition:
    """Return what a motor's recordings say of its rotor together: the first ones, and the latest ones."""
    first = _of_motor(motor).order_by(*_ORDER).limit(MOST_OF_EACH_END)
    entries = {row.recording_id: _entry(*row) for row in session.execute(first)}
    if len(entries) == MOST_OF_EACH_END:
        entries |= {one.recording_id: one for one in latest_findings(session, motor, MOST_OF_EACH_END)}
    return rotor_condition([DatedFinding(one.time_ns, one.finding) for one in entries.values()])


def keep_rotor_finding(
    session: Session, recording_id: str, motor: str, time_ns: int, finding: RotorFinding | None
) -> None:
    """Keep what a recording shows of the rotor, in place of what an earlier diagnosis found."""
    forget_rotor_finding(session, recording_id)
    if finding is None:
        return
    values = {name: getattr(finding, name) for name in _FIGURES}
    values |= dict(zip(_ENDS, finding.severity_dB_ci95 or (None, None), strict=True))
    values["reasons"] = tuple(map(storable, finding.reasons))
    session.add(RotorFindingRow(recording_id=recording_id, motor=motor, time_ns=time_ns, **values))
    session.flush()


def forget_rotor_finding(session: Session, recording_id: str) -> None:
    """Delete what a recording showed of the rotor."""
    session.execute(delete(RotorFindingRow).where(RotorFindingRow.recording_id == recording_id))


def _of_motor(motor: str) -> Select[*tuple[Any, ...]]:
    return select(*_COLUMNS).where(RotorFindingRow.motor == motor)


def _entry(recording_id: str, motor: str, time_ns: int, *values: Any) -> RotorEntry:
    *figures, low, high = values
    named: dict[str, Any] = dict(zip(_FIGURES, figures, strict=True))
    interval = None if low is None or high is None else (low, high)
    return RotorEntry(recording_id, motor, time_ns, RotorFinding(**named, severity_dB_ci95=interval))
