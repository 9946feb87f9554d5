"""What recordings show of the rotor: kept with their diagnosis, and listed."""

from dataclasses import fields
from typing import Any, Final

from sqlalchemy import Select, func, select
from sqlalchemy.orm import Session

from core.rotor.finding import RotorFinding, RotorState
from core.rotor.trend import RotorCondition
from service.storage.models import MotorRow, RecordingRow, RotorFindingRow
from service.storage.records import Cursor, Page, RotorEntry
from service.storage.repository.history.rotor_course import (
    TOLD_STATES,
    Place,
    course_condition,
    judge_added,
    judged_again,
)
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


class RotorRows(Sessions):
    def rotor_condition(self, motor: str) -> RotorCondition:
        """Return what a motor's recordings say of its rotor together. Raises NotFoundError."""
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return course_condition(session, motor)

    def rotor_assessed_ns(self, motor: str) -> int | None:
        """Return the time of a motor's latest recording that told of its rotor [ns UTC]; None without any."""
        query = select(func.max(RotorFindingRow.time_ns)).where(
            RotorFindingRow.motor == motor, RotorFindingRow.condition.is_not(None)
        )
        with self._read() as session:
            return session.scalar(query)

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


def keep_rotor_finding(
    session: Session,
    recording_id: str,
    motor: str,
    time_ns: int,
    finding: RotorFinding | None,
    *,
    is_first: bool = False,
) -> None:
    """Keep what a recording shows of the rotor, in place of what an earlier diagnosis found.

    is_first: there was no earlier diagnosis.
    """
    counted = not is_first and session.get(RotorFindingRow, recording_id) is not None
    if not counted and (finding is None or finding.state not in TOLD_STATES):
        if finding is not None:  # nothing follows from one that cannot tell
            _put_in(session, recording_id, motor, time_ns, finding)
        return
    if not counted and finding is not None and not _parts(session, recording_id):
        (place,) = _put_in(session, recording_id, motor, time_ns, finding)
        judge_added(session, motor, place)
        return
    with judged_again(session, motor) as places:
        places += _taken_out(session, recording_id)
        if finding is not None:
            places += _put_in(session, recording_id, motor, time_ns, finding)


def forget_rotor_finding(session: Session, recording_id: str) -> None:
    """Delete what a recording showed of the rotor."""
    row = session.get(RotorFindingRow, recording_id)
    if row is not None:
        with judged_again(session, row.motor) as places:
            places += _taken_out(session, recording_id)


def _put_in(
    session: Session, recording_id: str, motor: str, time_ns: int, finding: RotorFinding
) -> list[Place]:
    """Add a finding; return where what counts has changed.

    A joined recording that tells stands for its parts.
    """
    values = {name: getattr(finding, name) for name in _FIGURES}
    values |= dict(zip(_ENDS, finding.severity_dB_ci95 or (None, None), strict=True))
    values["reasons"] = tuple(map(storable, finding.reasons))
    row = RotorFindingRow(recording_id=recording_id, motor=motor, time_ns=time_ns, **values)
    recording = session.get(RecordingRow, recording_id)
    joined_id = None if recording is None else recording.joined_id
    joined = None if joined_id is None else session.get(RotorFindingRow, joined_id)
    row.condition = None if joined is not None and _tells(joined) else _first_condition(row)
    session.add(row)
    changed = [row]
    if _tells(row):
        for part in _parts(session, recording_id):
            part.condition = None
            changed.append(part)
    return [Place(one.time_ns, one.recording_id) for one in changed]


def _taken_out(session: Session, recording_id: str) -> list[Place]:
    """Delete a finding; return where what counts has changed. The parts of a joined recording count again."""
    row = session.get(RotorFindingRow, recording_id)
    if row is None:
        return []
    changed = [row]
    for part in _parts(session, recording_id):
        part.condition = _first_condition(part)
        changed.append(part)
    session.delete(row)
    session.flush()
    return [Place(one.time_ns, one.recording_id) for one in changed]


def _parts(session: Session, recording_id: str) -> list[RotorFindingRow]:
    """Return what the recordings show that a recording was joined from."""
    recording = session.get(RecordingRow, recording_id)
    parts = () if recording is None else recording.parts or ()
    found_parts = (session.get(RotorFindingRow, part) for part in parts)
    return [part for part in found_parts if part is not None]


def _tells(row: RotorFindingRow) -> bool:
    return row.state in TOLD_STATES


def _first_condition(row: RotorFindingRow) -> RotorState | None:
    """Return a condition for a finding that counts from now on, until it is judged beside its neighbours."""
    return row.state if _tells(row) else None


def _of_motor(motor: str) -> Select[*tuple[Any, ...]]:
    return select(*_COLUMNS).where(RotorFindingRow.motor == motor)


def _entry(recording_id: str, motor: str, time_ns: int, *values: Any) -> RotorEntry:
    *figures, low, high = values
    named: dict[str, Any] = dict(zip(_FIGURES, figures, strict=True))
    interval = None if low is None or high is None else (low, high)
    return RotorEntry(recording_id, motor, time_ns, RotorFinding(**named, severity_dB_ci95=interval))
