"""What a motor's records showed, with what was said of the motor then; and when it started and stopped."""

from collections.abc import Collection, Sequence
from dataclasses import fields
from typing import Any

from sqlalchemy import func, select

from core.operation import Operation
from service.storage.models import ObservationRow, RecordingRow
from service.storage.records import ConditionFigures, RecordingEntry
from service.storage.records.history import SeenRecord
from service.storage.repository.conditions.observations import OBSERVED, record_observation
from service.storage.repository.sessions import Sessions, columns_of

_FIGURES = [field.name for field in fields(ConditionFigures)]


class SeenRecordRows(Sessions):
    def latest_records(
        self, motor: str, *, limit: int, before_ns: int | None = None
    ) -> tuple[SeenRecord, ...]:
        """Return what a motor's latest records showed, oldest first. before_ns: those from before a time."""
        figures = columns_of(ConditionFigures, ObservationRow)
        query = select(*OBSERVED, *figures).where(ObservationRow.motor == motor)
        if before_ns is not None:
            query = query.where(ObservationRow.time_ns < before_ns)
        order = (ObservationRow.time_ns.desc(), ObservationRow.recording_id.desc())
        width = len(OBSERVED)
        with self._read() as session:
            rows = session.execute(query.order_by(*order).limit(limit)).all()
        return tuple(_seen(row[:width], row[width:]) for row in reversed(rows))

    def operations(
        self, motor: str, kinds: Collection[Operation], *, limit: int, from_ns: int, to_ns: int
    ) -> tuple[RecordingEntry, ...]:
        """Return the latest recordings in which a motor does one of these, from_ns <= time < to_ns."""
        time_ns = func.coalesce(RecordingRow.recorded_ns, RecordingRow.announced_ns)
        query = (
            select(*columns_of(RecordingEntry, RecordingRow))
            .where(RecordingRow.motor == motor, RecordingRow.operation.in_(kinds))
            .where(time_ns >= from_ns, time_ns < to_ns)
            .order_by(RecordingRow.announced_ns.desc(), RecordingRow.id.desc())
            .limit(limit)
        )
        with self._read() as session:
            return tuple(RecordingEntry(*row) for row in session.execute(query))


def _seen(observed: Sequence[Any], said: Sequence[Any]) -> SeenRecord:
    record = record_observation(observed)
    figures = None if said[0] is None else ConditionFigures(**dict(zip(_FIGURES, said, strict=True)))
    return SeenRecord(record.recording_id, record.observation, figures)
