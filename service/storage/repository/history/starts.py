"""Recorded starts: kept with the diagnosis of their recording, and listed."""

from collections.abc import Mapping
from dataclasses import asdict
from math import isfinite
from typing import Any

from sqlalchemy import delete, exists, func, select
from sqlalchemy.orm import Session

from core.operation import Operation
from core.starts.figures import MotorStart, StartCurve
from service.storage.models import MotorRow, RecordingRow, StartRow
from service.storage.records import Cursor, Page, StartEntry
from service.storage.repository.sessions import Order, Sessions, found, only, page_of

_FIGURES = (
    "is_from_rest",
    "acceleration_s",
    "peak_current_A",
    "crest_current_A",
    "running_current_A",
    "lowest_voltage_V",
    "i2t_A2s",
    "i2t_over_s",
    "rated_current_A",
    "rated_voltage_V",
)
"""Columns that are called as the fields of a MotorStart are."""


class StartRows(Sessions):
    def starts(
        self, motor: str | None = None, *, limit: int, after: Cursor | None = None
    ) -> Page[StartEntry]:
        """Return the recorded starts of a motor or of all, latest first. Raises NotFoundError."""
        query = select(StartRow)
        if motor is not None:
            query = query.where(StartRow.motor == motor)
        order: Order = [StartRow.time_ns, StartRow.recording_id]
        with self._read() as session:
            if motor is not None:
                found(session, MotorRow, motor, "motor")
            return page_of(session, query, order, _entry, limit=limit, after=after, descending=True)

    def first_whole_start(self, motor: str, *, from_ns: int) -> StartEntry | None:
        """Return the first start of a motor from a time on that was recorded from rest to speed."""
        query = (
            select(StartRow)
            .where(StartRow.motor == motor, StartRow.time_ns >= from_ns)
            .where(StartRow.is_from_rest, StartRow.acceleration_s.is_not(None))
            .order_by(StartRow.time_ns, StartRow.recording_id)
        )
        with self._read() as session:
            row = only(session, query)
            return None if row is None else _entry(row)

    def unmeasured_starts(self, motor: str | None = None) -> int:
        """Return how many stored recordings of starts have no figures: those of earlier versions."""
        query = select(func.count()).where(
            RecordingRow.operation == Operation.START,
            ~exists().where(StartRow.recording_id == RecordingRow.id),
        )
        if motor is not None:
            query = query.where(RecordingRow.motor == motor)
        with self._read() as session:
            return session.scalar(query) or 0


def keep_start(
    session: Session, recording_id: str, motor: str, time_ns: int, start: MotorStart | None
) -> None:
    """Keep what a recording shows of a start, in place of what an earlier diagnosis found; None for none."""
    forget_start(session, recording_id)
    if start is None or not _is_finite(start):
        return
    figures = {name: getattr(start, name) for name in _FIGURES}
    session.add(
        StartRow(
            recording_id=recording_id, motor=motor, time_ns=time_ns, curve=asdict(start.curve), **figures
        )
    )


def forget_start(session: Session, recording_id: str) -> None:
    """Delete what a recording showed of a start."""
    session.execute(delete(StartRow).where(StartRow.recording_id == recording_id))


def _is_finite(start: MotorStart) -> bool:
    """Return whether all figures are numbers: samples near the largest number have no square."""
    curve = start.curve
    figures = [getattr(start, name) for name in _FIGURES]
    known = [one for one in (*figures, *curve.current_A, *(curve.voltage_V or ())) if one is not None]
    return all(map(isfinite, known))


def _entry(row: StartRow, *_: object) -> StartEntry:
    figures: dict[str, Any] = {name: getattr(row, name) for name in _FIGURES}
    return StartEntry(
        row.recording_id, row.motor, row.time_ns, MotorStart(**figures, curve=_curve(row.curve))
    )


def _curve(document: Mapping[str, Any]) -> StartCurve:
    volts = document["voltage_V"]
    return StartCurve(
        document["first_s"],
        document["step_s"],
        tuple(document["current_A"]),
        None if volts is None else tuple(volts),
    )
