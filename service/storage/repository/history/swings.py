"""What recordings show of the air gap and of swinging loads: kept with their diagnosis, and listed."""

from collections.abc import Mapping
from typing import Any, Final

from sqlalchemy import Select, delete, select
from sqlalchemy.orm import Session

from core.rotor.swing_findings import EccentricityFinding, PulsationFinding
from service.storage.models import MotorRow, SwingFindingRow
from service.storage.records import Cursor, Page, SwingEntry
from service.storage.repository.sessions import Order, Sessions, found, latest_of, page_of, within
from service.storage.texts import storable

_OF_GAP: Final[Mapping[str, str]] = {
    "gap_permeance_ripple": "permeance_ripple",
    "gap_standard_deviation": "standard_deviation",
    "gap_detection_limit": "detection_limit",
    "gap_lower_sideband_dB": "lower_sideband_dB",
    "gap_upper_sideband_dB": "upper_sideband_dB",
    "turn_load_torque": "load_torque",
    "turn_load_torque_deviation": "load_torque_deviation",
    "turn_frequency_hz": "rotation_frequency_hz",
    "gap_reasons": "reasons",
}
"""Columns, and the fields of an EccentricityFinding in them."""

_OF_LOAD: Final[Mapping[str, str]] = {
    "load_torque": "load_torque",
    "load_noise": "noise",
    "load_frequency_hz": "frequency_hz",
    "load_torque_deviation": "load_torque_deviation",
    "load_detection_limit": "detection_limit",
    "load_reasons": "reasons",
}
"""Columns, and the fields of a PulsationFinding in them."""

_COLUMNS: Final = [
    getattr(SwingFindingRow, name) for name in ("recording_id", "motor", "time_ns", *_OF_GAP, *_OF_LOAD)
]
_ORDER: Final[Order] = (SwingFindingRow.time_ns, SwingFindingRow.recording_id)


class SwingRows(Sessions):
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
        query = _of_motor(motor).where(*within(SwingFindingRow.time_ns, from_ns, to_ns))
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return page_of(session, query, _ORDER, _entry, limit=limit, after=after)

    def latest_swings(self, motor: str, *, limit: int) -> tuple[SwingEntry, ...]:
        """Return what a motor's latest recordings show of its air gap and its load, oldest first."""
        with self._read() as session:
            return latest_of(session, _of_motor(motor), _ORDER, _entry, limit=limit)


def keep_swings(
    session: Session,
    recording_id: str,
    motor: str,
    time_ns: int,
    eccentricity: EccentricityFinding | None,
    pulsation: PulsationFinding | None,
    *,
    is_first: bool = False,
) -> None:
    """Keep what a recording shows of air gap and load, in place of what an earlier diagnosis found.

    is_first: there was no earlier diagnosis.
    """
    if not is_first:
        forget_swings(session, recording_id)
    if eccentricity is None or pulsation is None:
        return
    values = {column: getattr(eccentricity, name) for column, name in _OF_GAP.items()}
    values |= {column: getattr(pulsation, name) for column, name in _OF_LOAD.items()}
    for reasons in ("gap_reasons", "load_reasons"):
        values[reasons] = tuple(map(storable, values[reasons]))
    session.add(SwingFindingRow(recording_id=recording_id, motor=motor, time_ns=time_ns, **values))


def forget_swings(session: Session, recording_id: str) -> None:
    """Delete what a recording showed of air gap and load."""
    session.execute(delete(SwingFindingRow).where(SwingFindingRow.recording_id == recording_id))


def _of_motor(motor: str) -> Select[*tuple[Any, ...]]:
    return select(*_COLUMNS).where(SwingFindingRow.motor == motor)


def _entry(recording_id: str, motor: str, time_ns: int, *figures: Any) -> SwingEntry:
    of_gap, of_load = figures[: len(_OF_GAP)], figures[len(_OF_GAP) :]
    return SwingEntry(
        recording_id,
        motor,
        time_ns,
        EccentricityFinding(**dict(zip(_OF_GAP.values(), of_gap, strict=True))),
        PulsationFinding(**dict(zip(_OF_LOAD.values(), of_load, strict=True))),
    )
