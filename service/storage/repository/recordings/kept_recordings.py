"""Recordings that no rule of retention deletes, each with the reason why it stays.

A rule is applied again and again, so what stays must stay a second time: each condition looks only at what
stays too, at the newest, or at rows that a rule of retention never deletes.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from sqlalchemy import (
    ColumnElement,
    ScalarSelect,
    Select,
    and_,
    exists,
    false,
    func,
    literal,
    or_,
    select,
    true,
    tuple_,
)
from sqlalchemy.orm import Session

from core.diagnosis.verdict import Verdict
from core.operation import Operation
from service.storage.models import (
    AlarmRow,
    BaselineRecordingRow,
    ConditionChangeRow,
    ConditionCheckpointRow,
    ConditionEventRow,
    ConditionRow,
    DeletionRow,
    DiagnosisRow,
    JobRow,
    RecordingRow,
)
from service.storage.repository.motor_health import is_usable_start
from service.storage.states import AlarmState, JobState, RecordingState, StayReason

FIGURES = (Verdict.HEALTHY, Verdict.WATCH, Verdict.FAULT)
"""Verdicts that say something of the winding: one that was refused changes none."""

_ORDER = (DiagnosisRow.recorded_ns, DiagnosisRow.recording_id)

EARLIEST_NS, LATEST_NS = -(2**63), 2**63 - 1

Conditions = Mapping[StayReason, ColumnElement[bool]]


@dataclass(frozen=True, slots=True)
class Keeping:
    """What of a motor's recordings stays, whatever their age.

    newest: so many, counted by when they were seen and by when they were recorded.  starts: so many of the
    starts from which its parameters can be estimated, the newest.  first_ns: all that were first seen within
    this time of the motor's first.  changes: those before and after each change of verdict or condition.
    operations: all in which the motor does one of these.  one_in_ns: of each such time the first that has a
    verdict.
    """

    newest: int
    starts: int = 0
    first_ns: int | None = None
    changes: bool = False
    operations: tuple[Operation, ...] = ()
    one_in_ns: int | None = None


def conditions(session: Session, motor: str, keeping: Keeping) -> Conditions:
    """Return for each reason the condition that a recording of the motor stays because of it.

    None of them is null: it can be negated.
    """
    of_motor = RecordingRow.motor == motor
    kept_starts = (
        select(RecordingRow.id)
        .where(of_motor, is_usable_start())
        .order_by(RecordingRow.announced_ns.desc(), RecordingRow.id.desc())
        .limit(keeping.starts)
    )
    return {
        StayReason.RUNNING: exists().where(
            JobRow.recording_id == RecordingRow.id, JobRow.state == JobState.RUNNING
        ),
        StayReason.BASELINE: exists().where(BaselineRecordingRow.recording_id == RecordingRow.id),
        StayReason.ALARM: _of_an_open_alarm(motor),
        StayReason.NOTE: _beside_an_event(motor),
        StayReason.CHECKPOINT: exists().where(
            ConditionCheckpointRow.motor == motor, ConditionCheckpointRow.time_ns == RecordingRow.recorded_ns
        ),
        StayReason.NEWEST: _is_newest(session, motor, keeping.newest),
        StayReason.STARTS: RecordingRow.id.in_(session.scalars(kept_starts).all()),
        StayReason.FIRST: _is_early(session, motor, keeping.first_ns),
        StayReason.CHANGE: _beside_a_change(motor) if keeping.changes else false(),
        StayReason.OPERATION: and_(
            RecordingRow.operation.is_not(None), RecordingRow.operation.in_(keeping.operations)
        ),
        StayReason.ONE_IN: _is_first_of_its_time(motor, keeping.one_in_ns),
    }


def _is_newest(session: Session, motor: str, number: int) -> ColumnElement[bool]:
    seen, recorded = (
        session.scalar(
            select(time)
            .where(
                RecordingRow.motor == motor,
                RecordingRow.state != RecordingState.ANNOUNCED,
                time.is_not(None),
            )
            .order_by(time.desc())
            .offset(number - 1)
            .limit(1)
        )
        for time in (RecordingRow.announced_ns, RecordingRow.recorded_ns)
    )
    if seen is None:
        return true()
    is_timed = RecordingRow.recorded_ns.is_not(None)
    by_recorded = is_timed if recorded is None else and_(is_timed, RecordingRow.recorded_ns >= recorded)
    return or_(RecordingRow.announced_ns >= seen, by_recorded)


def _is_early(session: Session, motor: str, within_ns: int | None) -> ColumnElement[bool]:
    """The first one may have been deleted since; then the list of deletions knows when it was seen."""
    if within_ns is None:
        return false()
    firsts = [
        session.scalar(select(func.min(row.announced_ns)).where(row.motor == motor))
        for row in (RecordingRow, DeletionRow)
    ]
    known = [first for first in firsts if first is not None]
    return RecordingRow.announced_ns < min(known) + within_ns if known else false()


def _of_an_open_alarm(motor: str) -> ColumnElement[bool]:
    """The one that raised an alarm of the motor, and those at which the condition became what it tells."""
    is_open = (AlarmRow.motor == motor, AlarmRow.state != AlarmState.NORMAL)
    changed = and_(
        ConditionChangeRow.motor == motor,
        ConditionChangeRow.recording_id == RecordingRow.id,
        ConditionChangeRow.time_ns >= func.coalesce(_since(motor), EARLIEST_NS),
    )
    return or_(
        exists().where(*is_open, AlarmRow.recording_id == RecordingRow.id),
        and_(exists().where(*is_open), exists().where(changed)),
    )


def _since(motor: str) -> ScalarSelect[int | None]:
    return select(ConditionRow.since_ns).where(ConditionRow.motor == motor).scalar_subquery()


def _beside_an_event(motor: str) -> ColumnElement[bool]:
    """The last one before and the first one after what somebody told: a note, or another winding."""
    return and_(
        _says_something(motor),
        exists().where(
            ConditionEventRow.motor == motor,
            ConditionEventRow.withdrawn_ns.is_(None),
            ConditionEventRow.time_ns >= func.coalesce(_before(motor, "recorded_ns"), EARLIEST_NS),
            ConditionEventRow.time_ns <= func.coalesce(_after(motor, "recorded_ns"), LATEST_NS),
        ),
    )


def _beside_a_change(motor: str) -> ColumnElement[bool]:
    """The last one of the old verdict and the first one of the new; the same of the condition."""
    of_motor = ConditionChangeRow.motor == motor
    verdicts = (func.coalesce(neighbour(motor, "verdict"), "") for neighbour in (_before, _after))
    return or_(
        exists().where(of_motor, ConditionChangeRow.recording_id == RecordingRow.id),
        and_(
            _says_something(motor),
            or_(
                *(verdict != _own(motor, "verdict") for verdict in verdicts),
                exists().where(of_motor, ConditionChangeRow.recording_id == _after(motor, "recording_id")),
            ),
        ),
    )


def _is_first_of_its_time(motor: str, one_in_ns: int | None) -> ColumnElement[bool]:
    if one_in_ns is None:
        return false()
    began_ns = RecordingRow.recorded_ns - RecordingRow.recorded_ns % literal(one_in_ns)
    before_ns = func.coalesce(_before(motor, "recorded_ns"), EARLIEST_NS)
    return and_(_says_something(motor), before_ns < began_ns)


def _says_something(motor: str) -> ColumnElement[bool]:
    """Return whether the recording has a verdict on the winding. It has a time then."""
    return exists(_saying(motor, "id").where(DiagnosisRow.recording_id == RecordingRow.id))


def _own(motor: str, column: str) -> ScalarSelect[Any]:
    query = _saying(motor, column).where(DiagnosisRow.recording_id == RecordingRow.id)
    return query.correlate(RecordingRow).scalar_subquery()


def _before(motor: str, column: str) -> ScalarSelect[Any]:
    """Return a column of the diagnosis before that of the recording; null where it is the first."""
    query = _saying(motor, column).where(tuple_(*_ORDER) < tuple_(RecordingRow.recorded_ns, RecordingRow.id))
    latest = query.order_by(*(column.desc() for column in _ORDER)).limit(1)
    return latest.correlate(RecordingRow).scalar_subquery()


def _after(motor: str, column: str) -> ScalarSelect[Any]:
    """Return a column of the diagnosis after that of the recording; null where it is the last."""
    query = _saying(motor, column).where(tuple_(*_ORDER) > tuple_(RecordingRow.recorded_ns, RecordingRow.id))
    return query.order_by(*_ORDER).limit(1).correlate(RecordingRow).scalar_subquery()


def _saying(motor: str, column: str) -> Select[Any]:
    """Return a query for a column of the motor's diagnoses that say something of its winding."""
    # All of these columns are in the index of the trend: no row with its document is read.
    return select(getattr(DiagnosisRow, column)).where(
        DiagnosisRow.motor == motor,
        DiagnosisRow.current,
        DiagnosisRow.says_nothing.is_(False),
        DiagnosisRow.verdict.in_(FIGURES),
    )
