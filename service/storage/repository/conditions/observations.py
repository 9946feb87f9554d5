"""Observations: what each record tells of its motor's condition."""

from collections.abc import Sequence
from dataclasses import fields
from math import isfinite
from typing import Any

from sqlalchemy import Select, func, select
from sqlalchemy.orm import Session

from core.condition.observation import Observation
from service.storage.errors import UnstorableDiagnosisError
from service.storage.models import (
    ConditionRow,
    FoldMarkRow,
    MotorRow,
    ObservationRow,
    RecordingRow,
)
from service.storage.records import (
    Backlog,
    ConditionPoint,
    Cursor,
    Page,
    RecordObservation,
)
from service.storage.repository.conditions.fold_marks import mark_with_bus, resume
from service.storage.repository.sessions import Order, Sessions, columns_of, found, latest_of, page_of, within
from service.storage.texts import storable

PHASORS = (
    ("positive_voltage", "positive_voltage_V"),
    ("negative_voltage", "negative_voltage_V"),
    ("zero_voltage", "zero_voltage_V"),
    ("positive_current", "positive_current_A"),
    ("negative_current", "negative_current_A"),
    ("zero_current", "zero_current_A"),
)
"""Columns without their suffix, and the fields of an Observation."""

OTHERS = (
    "time_ns",
    "sequence",
    "voltage_channels",
    "frequency_hz",
    "scatter",
    "cycles",
    "load_level",
)
"""Columns that are called as the fields are."""


OBSERVED = [
    ObservationRow.__table__.c[name]
    for name in (
        "recording_id",
        "motor",
        "recorder",
        *OTHERS,
        *(f"{column}_{part}" for column, _ in PHASORS for part in ("re", "im")),
    )
]
"""Columns of what a recording tells, without what is said from it on."""

_ORDER: Order = (ObservationRow.time_ns, ObservationRow.recording_id)
_POINT_FIELDS = [field.name for field in fields(ConditionPoint)]


class ObservationRows(Sessions):
    def observation(self, recording_id: str) -> RecordObservation | None:
        """Return what a recording tells of its motor's condition; None where it tells nothing."""
        with self._read() as session:
            row = session.get(ObservationRow, recording_id)
            return None if row is None else _of_row(row)

    def condition_trend(
        self,
        motor: str,
        *,
        limit: int,
        from_ns: int | None = None,
        to_ns: int | None = None,
        after: Cursor | None = None,
        descending: bool = False,
    ) -> Page[ConditionPoint]:
        """Return what was said from each record on, oldest first, from_ns <= time < to_ns.

        descending: newest first instead.
        A record that is not folded yet is not there. Raises NotFoundError.
        """
        query = _folded(motor).where(*within(ObservationRow.time_ns, from_ns, to_ns))
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return page_of(session, query, _ORDER, point, limit=limit, after=after, descending=descending)

    def latest_condition_points(self, motor: str, *, limit: int) -> tuple[ConditionPoint, ...]:
        """Return what was said from each of a motor's latest records on, oldest first."""
        with self._read() as session:
            return latest_of(session, _folded(motor), _ORDER, point, limit=limit)

    def leave_out(self, recording_id: str, reason: str, program: str) -> None:
        """Have a motor's condition follow without one of its recordings, which is kept with the reason.

        It is taken in again with another diagnosis, and by another program. program: the version that failed.
        """
        with self._write() as session:
            row = session.get(ObservationRow, recording_id)
            if row is None:
                return
            row.left_out, row.left_out_by = storable(reason), program
            row.state, row.kind = None, None
            mark_with_bus(session, row.motor, row.time_ns)
            recording = session.get(RecordingRow, recording_id)
            if recording is not None:
                recording.reason = storable(reason)

    def backlog(self) -> Backlog:
        """Return how much the conditions are behind the recordings; of motors in service."""
        in_service = select(MotorRow.name).where(MotorRow.in_service)
        marked = select(func.count(FoldMarkRow.motor.distinct())).where(
            FoldMarkRow.set_aside.is_(False), FoldMarkRow.motor.in_(in_service)
        )
        problems = select(func.count(ConditionRow.motor)).where(
            ConditionRow.problem.is_not(None), ConditionRow.motor.in_(in_service)
        )
        with self._read() as session:
            return Backlog(*(session.scalar(query) or 0 for query in (marked, problems)))


def keep_observation(
    session: Session,
    recording_id: str,
    motor: str,
    observation: Observation | None,
    *,
    is_first: bool = False,
) -> None:
    """Keep what a recording tells instead of what it told before, if anything, and have it folded.

    is_first: it was never diagnosed before, so it told nothing. Raises UnstorableDiagnosisError.
    """
    before = None if is_first else session.get(ObservationRow, recording_id)
    row = None if observation is None else observation_row(recording_id, motor, observation)
    if before is not None:
        if row is not None and _of_row(before) == _of_row(row):
            if before.left_out is not None:
                take_in_again(session, before)
            resume(session, FoldMarkRow.motor == motor)
            return
        forget_observation(session, recording_id)
    if row is not None:
        session.add(row)
        session.flush()
        mark_with_bus(session, motor, row.time_ns)


def take_in_again(session: Session, row: ObservationRow) -> None:
    """Have a record folded that was left out."""
    row.left_out, row.left_out_by = None, None
    recording = session.get(RecordingRow, row.recording_id)
    if recording is not None:
        recording.reason = None
    mark_with_bus(session, row.motor, row.time_ns)


def forget_observation(session: Session, recording_id: str) -> None:
    """Delete what a recording told, as if it had never been, and have its motor folded without it."""
    row = session.get(ObservationRow, recording_id)
    if row is not None:
        mark_with_bus(session, row.motor, row.time_ns)
        session.delete(row)
        session.flush()


def record_observation(values: Sequence[Any]) -> RecordObservation:
    """Return what a recording tells. values: of the columns of OBSERVED, in their order."""
    (
        recording_id, motor, recorder,
        time_ns, sequence, voltage_channels, frequency_hz, scatter, cycles, load_level,
        V1_re, V1_im, V2_re, V2_im, V0_re, V0_im, I1_re, I1_im, I2_re, I2_im, I0_re, I0_im,
    ) = values  # fmt: skip
    observation = Observation(
        time_ns=time_ns,
        recorder=recorder,
        sequence=sequence,
        voltage_channels=voltage_channels,
        frequency_hz=frequency_hz,
        positive_voltage_V=complex(V1_re, V1_im),
        negative_voltage_V=complex(V2_re, V2_im),
        zero_voltage_V=None if V0_re is None or V0_im is None else complex(V0_re, V0_im),
        positive_current_A=complex(I1_re, I1_im),
        negative_current_A=complex(I2_re, I2_im),
        zero_current_A=complex(I0_re, I0_im),
        scatter=scatter,
        cycles=cycles,
        load_level=load_level,
    )
    return RecordObservation(recording_id, motor, observation)


def _of_row(row: ObservationRow) -> RecordObservation:
    return record_observation([getattr(row, column.name) for column in OBSERVED])


def _folded(motor: str) -> Select[*tuple[Any, ...]]:
    """Return the query of what was said from each record of a motor on that is folded."""
    columns = columns_of(ConditionPoint, ObservationRow)
    return select(*columns).where(ObservationRow.motor == motor, ObservationRow.state.is_not(None))


def point(*values: Any) -> ConditionPoint:
    """Return what was said from a record on. values: of the columns of a ConditionPoint."""
    return ConditionPoint(**dict(zip(_POINT_FIELDS, values, strict=True)))


def observation_row(recording_id: str, motor: str, observation: Observation) -> ObservationRow:
    """Return the row of what a recording tells. Raises UnstorableDiagnosisError."""
    row = ObservationRow(recording_id=recording_id, motor=motor, recorder=storable(observation.recorder))
    for column, field in PHASORS:
        value: complex | None = getattr(observation, field)
        setattr(row, f"{column}_re", None if value is None else _finite(field, value.real))
        setattr(row, f"{column}_im", None if value is None else _finite(field, value.imag))
    for name in OTHERS:
        value = getattr(observation, name)
        setattr(row, name, _finite(name, value) if isinstance(value, float) else value)
    return row


def _finite(field: str, value: float) -> float:
    if not isfinite(value):
        raise UnstorableDiagnosisError(f"the observation's {field} is {value}, no finite number")
    return value + 0.0  # SQLite does not keep the sign of a zero
