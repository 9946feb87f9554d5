"""Folding: what of a motor has changed, and what follows from it.

Whoever changes something leaves a mark. A fold takes the marks, goes on from the last checkpoint before the
earliest, and takes those marks away when it is done: a mark that comes meanwhile stays. Of two that fold the
same motor at the same time, the first to end is kept, for the other began from an older version.
"""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields
from functools import cache

from sqlalchemy import Update, bindparam, delete, func, insert, or_, select, update
from sqlalchemy.orm import Session

from service.alarms.condition_rules import AT_ONCE, ConditionRules
from service.storage.models import (
    Base,
    ConditionChangeRow,
    ConditionCheckpointRow,
    ConditionRow,
    FoldMarkRow,
    MotorRow,
    ObservationRow,
)
from service.storage.records import (
    Checkpoint,
    ConditionChange,
    ConditionFigures,
    FoldInput,
    FoldResult,
    TrackedPoint,
)
from service.storage.repository.alarms.conditions import settle_alarm
from service.storage.repository.conditions.fold_input import fold_input
from service.storage.repository.conditions.fold_marks import EARLIEST_NS, mark, others_of_bus, resume
from service.storage.repository.conditions.motor_conditions import settle_motor_condition
from service.storage.repository.conditions.observations import take_in_again
from service.storage.repository.conditions.standing_changes import TOLD, is_material
from service.storage.repository.history.condition_days import keep_days
from service.storage.repository.sessions import NONE_HELD, Sessions, found, record_of, values_of
from service.storage.texts import storable

_OBSERVATIONS = Base.metadata.tables["observations"]
"""The table, not the class: statements for many rows at once look at no object of the session."""

_SAID = tuple(field.name for field in fields(ConditionFigures))
_FOLLOWED = tuple(
    field.name for field in fields(TrackedPoint) if field.name not in ("recording_id", "time_ns")
)
"""Columns that a fold writes from each record on."""

IDS_A_STATEMENT = 500
"""Databases limit how many values a statement may hold."""


class FoldingRows(Sessions):
    def motors_to_fold(self) -> tuple[str, ...]:
        """Return the motors of which something has changed; those set aside with the next change only."""
        return tuple(self.earliest_marks())

    def earliest_marks(self) -> Mapping[str, int]:
        """Return from which time on each motor is to be folded, by the motors' names, in their order.

        Motors that are out of service wait until they are back.
        """
        waiting = (
            select(FoldMarkRow.motor, func.min(FoldMarkRow.from_ns))
            .join(MotorRow, MotorRow.name == FoldMarkRow.motor)
            .where(FoldMarkRow.set_aside.is_(False), MotorRow.in_service)
            .group_by(FoldMarkRow.motor)
            .order_by(FoldMarkRow.motor)
        )
        with self._read() as session:
            return dict(session.execute(waiting).all())

    def fold_marks(self, motor: str) -> tuple[str, ...]:
        """Return the ids of a motor's marks: the changes that a fold beginning now takes in."""
        with self._read() as session:
            return tuple(session.scalars(select(FoldMarkRow.id).where(FoldMarkRow.motor == motor)))

    def set_fold_aside(self, motor: str, marks: Sequence[str], problem: str) -> None:
        """Have a motor folded no more until something changes again, and keep why.

        marks: what could not be folded. A mark that came meanwhile stays, and has the motor tried again.
        """
        with self._write() as session:
            session.execute(
                update(ConditionRow).where(ConditionRow.motor == motor).values(problem=storable(problem))
            )
            for some in _in_parts(marks):
                session.execute(update(FoldMarkRow).where(FoldMarkRow.id.in_(some)).values(set_aside=True))

    def resume_folds(self, program: str) -> None:
        """Have folded what was set aside, and what another program left out: this one may be mended."""
        left_out = (
            select(ObservationRow)
            .join(MotorRow, MotorRow.name == ObservationRow.motor)
            .where(
                ObservationRow.left_out.is_not(None),
                ObservationRow.left_out_by.is_distinct_from(program),
                MotorRow.in_service,
            )
        )
        with self._write() as session:
            resume(session)
            for row in session.scalars(left_out).all():
                take_in_again(session, row)

    def motors_judged_by_other_rules(self, rules: str) -> tuple[str, ...]:
        """Return the motors in service that have a condition by other rules, in the order of their names."""
        query = (
            select(ConditionRow.motor)
            .join(MotorRow, MotorRow.name == ConditionRow.motor)
            .where(
                ConditionRow.as_of_ns.is_not(None),
                ConditionRow.rules.is_distinct_from(rules),
                MotorRow.in_service,
            )
        )
        with self._read() as session:
            return tuple(session.scalars(query.order_by(ConditionRow.motor)))

    def judge_anew(self, motor: str, rules: str) -> bool:
        """Have a motor folded from the first record on, unless it is already, or these rules have judged it.

        Its condition stays as it is until that is done. Returns whether it is new. Raises NotFoundError.
        """
        marked = select(FoldMarkRow.id).where(FoldMarkRow.motor == motor, FoldMarkRow.from_ns == EARLIEST_NS)
        with self._write() as session:
            judged = found(session, ConditionRow, motor, "motor").rules == rules
            if judged or session.scalar(marked.limit(1)) is not None:
                return False
            mark(session, motor, EARLIEST_NS)
            return True

    def begin_fold(self, motor: str, most_records: int) -> FoldInput | None:
        """Return what a fold of a motor needs, with about so many observations; None where none is due.

        Records of one time are not parted. Raises NotFoundError.
        """
        with self._read() as session:
            version = found(session, ConditionRow, motor, "motor").version
            # Marks before what they are for: what comes in between has a mark of its own, which stays.
            marks = dict(
                session.execute(
                    select(FoldMarkRow.id, FoldMarkRow.from_ns).where(FoldMarkRow.motor == motor)
                ).all()
            )
            return fold_input(session, motor, version, marks, most_records) if marks else None

    def finish_fold(
        self, fold: FoldInput, result: FoldResult, *, now_ns: int, rules: ConditionRules = AT_ONCE
    ) -> bool:
        """Keep what a fold found, all of it or nothing; have the rest folded, if there is one.

        With the condition go the motor's alarms: they are raised or cleared at `now_ns` by these rules.
        Returns False, and keeps nothing, where another fold of the motor has ended since this one began.
        """
        done_ns = EARLIEST_NS if fold.checkpoint is None else fold.checkpoint.time_ns
        with self._write() as session:
            # The motor first, as all who keep a diagnosis or alarms do: nobody waits for somebody who waits.
            motor = found(session, MotorRow, fold.motor, "motor", lock=True)
            row = found(session, ConditionRow, fold.motor, "motor", lock=True)
            if row.version != fold.version:
                return False
            row.version += 1
            row.problem = None
            if fold.checkpoint is None:
                row.rules = result.rules
            with session.no_autoflush:  # none of this looks at the condition's row, which changes below
                _replace_written(session, fold, result, done_ns)
            if result.condition is not None:
                for name, value in values_of(result.condition).items():
                    if name not in ("motor", "version"):
                        setattr(row, name, value)
                row.stator, row.parameters = result.condition.document, result.parameters
                told = None if row.standing is None else row.standing.get(TOLD)
                if is_material(told, result.standing):
                    told = result.standing
                    with session.no_autoflush:  # the rows of others are read, and the row's own comes once
                        _mark_latest_of_bus(session, fold.motor)
                row.standing = None if result.standing is None else {**result.standing, TOLD: told}
                settle_alarm(session, motor, result.condition, now_ns=now_ns, rules=rules)
                settle_motor_condition(session, row, now_ns=now_ns)
            return True

    def forget_checkpoints(self, motor: str) -> None:
        """Have a motor folded from its first record on. Raises NotFoundError."""
        with self._write() as session:
            found(session, ConditionRow, motor, "motor", lock=True).version += 1
            session.execute(delete(ConditionCheckpointRow).where(ConditionCheckpointRow.motor == motor))
            mark(session, motor, EARLIEST_NS)

    def checkpoints(self, motor: str) -> tuple[Checkpoint, ...]:
        """Return a motor's checkpoints, oldest first."""
        query = (
            select(ConditionCheckpointRow)
            .where(ConditionCheckpointRow.motor == motor)
            .order_by(ConditionCheckpointRow.time_ns)
        )
        with self._read() as session:
            return tuple(record_of(Checkpoint, row) for row in session.scalars(query))


def _replace_written(session: Session, fold: FoldInput, result: FoldResult, done_ns: int) -> None:
    """Write what a fold found record by record, in place of what was there, and take its marks away."""
    for some in _in_parts(fold.marks):
        session.execute(delete(FoldMarkRow).where(FoldMarkRow.id.in_(some)), execution_options=NONE_HELD)
    if fold.next_ns is not None:
        mark(session, fold.motor, fold.next_ns)
    _write_points(session, result)
    after_ns = None if fold.checkpoint is None else done_ns
    keep_days(session, fold.motor, after_ns=after_ns, before_ns=fold.next_ns)
    _write_changes(session, fold, result.changes, done_ns)
    _write_checkpoints(session, fold.motor, result)


def _mark_latest_of_bus(session: Session, motor: str) -> None:
    """Have the others of the bus judged anew: what stands in all of them is the bus's, not theirs."""
    query = select(ConditionRow.motor, ConditionRow.as_of_ns).where(
        ConditionRow.motor.in_(others_of_bus(motor)), ConditionRow.as_of_ns.is_not(None)
    )
    for other, as_of_ns in session.execute(query).all():
        if as_of_ns is not None:
            mark(session, other, as_of_ns)


def _write_points(session: Session, result: FoldResult) -> None:
    """Write what is said, and how parameters changed, from each record on; deleted ones are left out.

    A record that has both takes one statement.
    """
    written: dict[str, dict[str, object]] = defaultdict(dict)
    for names, points in ((_SAID, result.points), (_FOLLOWED, result.tracked)):
        for point in points:
            written[point.recording_id] |= {name: getattr(point, name) for name in names}
    alike: dict[tuple[str, ...], list[dict[str, object]]] = defaultdict(list)
    for recording_id, values in written.items():
        alike[tuple(values)].append({"of_recording": recording_id, **values})
    for names, rows in alike.items():
        session.connection().execute(_written(names), rows)


@cache
def _written(names: tuple[str, ...]) -> Update:
    """Return the statement that writes these columns of one record: to put it together takes long."""
    of_one = _OBSERVATIONS.c.recording_id == bindparam("of_recording")
    return update(_OBSERVATIONS).where(of_one).values({name: bindparam(name) for name in names})


def _write_changes(
    session: Session, fold: FoldInput, changes: Sequence[ConditionChange], done_ns: int
) -> None:
    """Replace the changes of the times that were folded. Those of deleted recordings are anywhere later."""
    old = delete(ConditionChangeRow).where(
        ConditionChangeRow.motor == fold.motor, ConditionChangeRow.time_ns > done_ns
    )
    if fold.next_ns is not None:
        ids = [change.id for change in changes]
        old = old.where(or_(ConditionChangeRow.time_ns < fold.next_ns, ConditionChangeRow.id.in_(ids)))
    session.execute(old, execution_options=NONE_HELD)
    if changes:
        session.execute(
            insert(ConditionChangeRow), [{"id": change.id, **values_of(change)} for change in changes]
        )


def _write_checkpoints(session: Session, motor: str, result: FoldResult) -> None:
    session.execute(
        delete(ConditionCheckpointRow).where(
            ConditionCheckpointRow.motor == motor,
            ConditionCheckpointRow.time_ns.not_in(result.kept_checkpoints),
        ),
        execution_options=NONE_HELD,
    )
    if result.checkpoints:
        rows = [{"motor": motor, **values_of(one)} for one in result.checkpoints]
        session.execute(insert(ConditionCheckpointRow), rows)


def _in_parts(ids: Sequence[str]) -> Iterator[Sequence[str]]:
    for first in range(0, len(ids), IDS_A_STATEMENT):
        yield ids[first : first + IDS_A_STATEMENT]
