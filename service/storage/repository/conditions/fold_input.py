"""What a fold of a motor needs: its observations, events and changes from a checkpoint on."""

from collections.abc import Iterator, Mapping, Sequence

from sqlalchemy import bindparam, func, select
from sqlalchemy.orm import Session

from core.condition.events import EventKind
from core.condition.observation import SAME_SUPPLY_WITHIN_NS
from service.storage.models import (
    ConditionChangeRow,
    ConditionCheckpointRow,
    ConditionEventRow,
    ConditionRow,
    MotorRow,
    MotorVersionRow,
    ObservationRow,
)
from service.storage.records import (
    BusMotor,
    Checkpoint,
    ConditionChange,
    ConditionEvent,
    FoldInput,
    MotorVersion,
    RecordObservation,
)
from service.storage.repository.conditions.fold_marks import EARLIEST_NS, others_of_bus
from service.storage.repository.conditions.observations import OBSERVED, record_observation
from service.storage.repository.conditions.tracking import followed_starts
from service.storage.repository.sessions import only, record_of

_BUS = select(MotorRow.bus).where(MotorRow.name == bindparam("of_motor"))


def fold_input(
    session: Session, motor: str, version: int, marks: Mapping[str, int], most_records: int
) -> FoldInput:
    """Return what a fold of a motor needs, with about so many observations. Records of one time stay whole.

    version: of its condition.  marks: from when on there is something to fold [ns], by their ids.
    """
    checkpoint = _checkpoint_before(session, motor, min(marks.values()))
    done_ns = EARLIEST_NS if checkpoint is None else checkpoint.time_ns
    observations, next_ns = _observations(session, motor, done_ns, most_records)
    has_bus = session.scalar(_BUS, {"of_motor": motor}) is not None
    return FoldInput(
        motor=motor,
        version=version,
        marks=tuple(marks),
        checkpoint=checkpoint,
        earlier=_earlier_checkpoints(session, motor, done_ns),
        observations=observations,
        next_ns=next_ns,
        events=_events(session, motor, done_ns, next_ns),
        bus=_bus(session, motor) if has_bus else (),
        neighbours=_neighbours(session, motor, observations) if has_bus else (),
        motor_versions=tuple(_versions(session, motor)),
        latest_change=_latest_change(session, motor, done_ns),
        starts=followed_starts(session, motor, done_ns, next_ns),
    )


def _checkpoint_before(session: Session, motor: str, from_ns: int) -> Checkpoint | None:
    query = (
        select(ConditionCheckpointRow)
        .where(ConditionCheckpointRow.motor == motor, ConditionCheckpointRow.time_ns < from_ns)
        .order_by(ConditionCheckpointRow.time_ns.desc())
    )
    row = only(session, query)
    return None if row is None else record_of(Checkpoint, row)


def _earlier_checkpoints(session: Session, motor: str, done_ns: int) -> Mapping[int, int]:
    """Return the numbers of records of the checkpoints up to a time, by their times."""
    query = select(ConditionCheckpointRow.time_ns, ConditionCheckpointRow.records).where(
        ConditionCheckpointRow.motor == motor, ConditionCheckpointRow.time_ns <= done_ns
    )
    return dict(session.execute(query).all())


def _observations(
    session: Session, motor: str, done_ns: int, most: int
) -> tuple[tuple[RecordObservation, ...], int | None]:
    """Return the next observations of a motor, whole times only, and the time of the first one beyond."""
    following = (
        select(*OBSERVED)
        .where(
            ObservationRow.motor == motor, ObservationRow.time_ns > done_ns, ObservationRow.left_out.is_(None)
        )
        .order_by(ObservationRow.time_ns, ObservationRow.recording_id)
    )
    rows = session.execute(following.limit(most + 1)).all()
    next_ns = None
    if len(rows) > most:
        next_ns = rows[most].time_ns
        rows = [row for row in rows if row.time_ns < next_ns]
        if not rows:
            rows = session.execute(following.where(ObservationRow.time_ns == next_ns)).all()
            next_ns = session.scalar(
                select(func.min(ObservationRow.time_ns)).where(
                    ObservationRow.motor == motor,
                    ObservationRow.time_ns > rows[0].time_ns,
                    ObservationRow.left_out.is_(None),
                )
            )
    return tuple(record_observation(row) for row in rows), next_ns


def _events(session: Session, motor: str, done_ns: int, next_ns: int | None) -> tuple[ConditionEvent, ...]:
    """Return the next events of a motor, in their order, without notes and what was withdrawn."""
    query = select(ConditionEventRow).where(
        ConditionEventRow.motor == motor,
        ConditionEventRow.time_ns > done_ns,
        ConditionEventRow.kind != EventKind.NOTE,
        ConditionEventRow.withdrawn_ns.is_(None),
    )
    if next_ns is not None:
        query = query.where(ConditionEventRow.time_ns < next_ns)
    order = (ConditionEventRow.time_ns, ConditionEventRow.made_ns, ConditionEventRow.id)
    return tuple(record_of(ConditionEvent, row) for row in session.scalars(query.order_by(*order)))


def _neighbours(
    session: Session, motor: str, observations: Sequence[RecordObservation]
) -> tuple[RecordObservation, ...]:
    """Return the observations of other motors of the bus in the time of these, in their order."""
    if not observations:
        return ()
    first_ns, last_ns = (observations[at].observation.time_ns for at in (0, -1))
    query = (
        select(*OBSERVED)
        .where(
            ObservationRow.motor.in_(others_of_bus(motor)),
            ObservationRow.left_out.is_(None),
            ObservationRow.time_ns.between(first_ns - SAME_SUPPLY_WITHIN_NS, last_ns + SAME_SUPPLY_WITHIN_NS),
        )
        .order_by(ObservationRow.time_ns, ObservationRow.recording_id)
    )
    return tuple(record_observation(row) for row in session.execute(query))


def _bus(session: Session, motor: str) -> tuple[BusMotor, ...]:
    document = (
        select(MotorVersionRow.document)
        .where(MotorVersionRow.motor == ConditionRow.motor)
        .order_by(MotorVersionRow.from_ns.desc())
        .limit(1)
        .scalar_subquery()
    )
    query = (
        select(ConditionRow.motor, document, ConditionRow.standing)
        .where(ConditionRow.motor.in_(others_of_bus(motor)))
        .order_by(ConditionRow.motor)
    )
    return tuple(BusMotor(*row) for row in session.execute(query))


def _versions(session: Session, motor: str) -> Iterator[MotorVersion]:
    query = select(MotorVersionRow).where(MotorVersionRow.motor == motor).order_by(MotorVersionRow.from_ns)
    return (record_of(MotorVersion, row) for row in session.scalars(query))


def _latest_change(session: Session, motor: str, done_ns: int) -> ConditionChange | None:
    query = (
        select(ConditionChangeRow)
        .where(ConditionChangeRow.motor == motor, ConditionChangeRow.time_ns <= done_ns)
        # Of one time, events come before records.
        .order_by(ConditionChangeRow.time_ns.desc(), ConditionChangeRow.event_id.is_not(None))
    )
    row = only(session, query)
    return None if row is None else record_of(ConditionChange, row)
