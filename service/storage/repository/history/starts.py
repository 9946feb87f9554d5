"""Recorded starts: kept with the diagnosis of their recording, and listed."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from math import isfinite
from typing import Any

from sqlalchemy import delete, exists, func, select
from sqlalchemy.orm import Session

from core.operation import Operation
from core.starts.changes import REFERENCE_STARTS
from core.starts.examined import ExaminedStart
from core.starts.figures import MotorStart, StartCurve
from service.storage.errors import NotFoundError
from service.storage.models import MotorRow, RecordingRow, StartRow
from service.storage.records import Cursor, Page, StartEntry
from service.storage.repository.conditions.tracking import follow_again, followed_start
from service.storage.repository.history.start_documents import examined_start
from service.storage.repository.sessions import Order, Sessions, found, page_of

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

LOOKED_AT = 10 * REFERENCE_STARTS
"""Starts among which the first whole ones are looked for."""


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

    def start(self, motor: str, recording_id: str) -> StartEntry:
        """Return what one recording shows of a start of a motor. Raises NotFoundError."""
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            row = session.get(StartRow, recording_id)
            if row is None or row.motor != motor:
                raise NotFoundError("start", recording_id)
            return _entry(row)

    def times_of_starts(self, motor: str, *, from_ns: int, to_ns: int) -> Sequence[int]:
        """Return when a motor was started between two times, both included, in their order."""
        query = (
            select(StartRow.time_ns)
            .where(StartRow.motor == motor, StartRow.time_ns >= from_ns, StartRow.time_ns <= to_ns)
            .order_by(StartRow.time_ns)
        )
        with self._read() as session:
            return session.scalars(query).all()

    def first_whole_starts(self, motor: str, *, from_ns: int) -> Sequence[StartEntry]:
        """Return the first few starts of a motor from a time on that were recorded from rest to speed.

        They are looked for among the first `LOOKED_AT` starts, however many a motor has.
        """
        query = (
            select(StartRow)
            .where(StartRow.motor == motor, StartRow.time_ns >= from_ns)
            .order_by(StartRow.time_ns, StartRow.recording_id)
            .limit(LOOKED_AT)
        )
        with self._read() as session:
            rows = session.scalars(query).all()
        whole = [row for row in rows if row.is_from_rest and row.acceleration_s is not None]
        return [_entry(row) for row in whole[:REFERENCE_STARTS]]

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
    session: Session, recording_id: str, motor: str, time_ns: int, start: ExaminedStart | None
) -> None:
    """Keep what a recording shows of a start, in place of what an earlier diagnosis found; None for none."""
    forget_start(session, recording_id)
    if start is None or not _is_finite(start.figures):
        return
    if followed_start(time_ns, start.parameters) is not None:
        follow_again(session, motor, time_ns)
    figures = {name: getattr(start.figures, name) for name in _FIGURES}
    model = start.model_as_dict()
    session.add(
        StartRow(
            recording_id=recording_id,
            motor=motor,
            time_ns=time_ns,
            curve=asdict(start.figures.curve),
            model=model if _is_storable(model) else None,
            **figures,
        )
    )


def forget_start(session: Session, recording_id: str) -> None:
    """Delete what a recording showed of a start."""
    row = session.get(StartRow, recording_id)
    if row is None:
        return
    if row.model is not None:
        follow_again(session, row.motor, row.time_ns)
    session.execute(delete(StartRow).where(StartRow.recording_id == recording_id))


def _is_storable(model: Mapping[str, object]) -> bool:
    """Return whether a document has nothing but numbers in it that JSON has, too."""
    try:
        json.dumps(model, allow_nan=False)
    except ValueError:
        return False
    return True


def _is_finite(start: MotorStart) -> bool:
    """Return whether all figures are numbers: samples near the largest number have no square."""
    curve = start.curve
    figures = [getattr(start, name) for name in _FIGURES]
    known = [one for one in (*figures, *curve.current_A, *(curve.voltage_V or ())) if one is not None]
    return all(map(isfinite, known))


def _entry(row: StartRow, *_: object) -> StartEntry:
    figures: dict[str, Any] = {name: getattr(row, name) for name in _FIGURES}
    start = MotorStart(**figures, curve=_curve(row.curve))
    return StartEntry(row.recording_id, row.motor, row.time_ns, examined_start(start, row.model))


def _curve(document: Mapping[str, Any]) -> StartCurve:
    volts = document["voltage_V"]
    return StartCurve(
        document["first_s"],
        document["step_s"],
        tuple(document["current_A"]),
        None if volts is None else tuple(volts),
    )
