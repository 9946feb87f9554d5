"""Measured values over time: as sampled for a while, as means of minutes and quarters of an hour later."""

from collections.abc import Iterable
from functools import cache
from itertools import pairwise
from time import monotonic
from typing import Any

from sqlalchemy import (
    BigInteger,
    ColumnElement,
    Insert,
    Integer,
    bindparam,
    case,
    column,
    delete,
    exists,
    func,
    insert,
    select,
    table,
)
from sqlalchemy.orm import Session, aliased

from core.units import NANOSECONDS_PER_SECOND
from service.plant import AveragingStep, MeteredQuantity
from service.storage.engine import one_at_a_time
from service.storage.models import MeasurementRow, MotorRow
from service.storage.partitions import DEFAULT, TABLE
from service.storage.records import Cursor, DeletedRows, Measurement, Page, Sample
from service.storage.repository.sessions import Order, Sessions, found, page_of, within
from service.storage.states import MeasurementSource

LATENESS_NS = 120 * NANOSECONDS_PER_SECOND
"""A mean is made when its interval ended this long ago: samples may be on their way until then."""

AVERAGING = "average measurements"
"""What one transaction does at a time."""

_COLUMNS = {quantity: MeasurementRow.__table__.c[quantity.value] for quantity in MeteredQuantity}

_MEASURED = (
    MeasurementRow.time_ns,
    MeasurementRow.samples,
    MeasurementRow.source,
    *_COLUMNS.values(),
)

_NAMES = [quantity.value for quantity in MeteredQuantity]

_OF_A_TIME = delete(MeasurementRow).where(
    MeasurementRow.motor == bindparam("of"),
    MeasurementRow.step_s == AveragingStep.AS_SAMPLED.value,
    MeasurementRow.time_ns == bindparam("at"),
)


class MeasurementRows(Sessions):
    def add_samples(self, samples: Iterable[Sample]) -> None:
        """Write samples; a second one of a motor at the very same time replaces the first."""
        latest = {(sample.motor, sample.time_ns): sample for sample in samples}
        if not latest:
            return
        with self._write() as session:
            at_times = [{"of": motor, "at": time_ns} for motor, time_ns in latest]
            session.connection().execute(_OF_A_TIME, at_times)
            insert_samples(session, latest.values(), MeasurementSource.POLLED)

    def latest_sample(self, motor: str, *, since_ns: int) -> Measurement | None:
        """Return what a motor's relay measured last, from a time on; None without anything."""
        query = (
            select(*_MEASURED)
            .where(
                MeasurementRow.motor == motor,
                MeasurementRow.step_s == AveragingStep.AS_SAMPLED.value,
                MeasurementRow.time_ns >= since_ns,
            )
            .order_by(MeasurementRow.time_ns.desc())
            .limit(1)
        )
        with self._read() as session:
            row = session.execute(query).first()
            return None if row is None else _measurement(*row)

    def average_measurements(self, *, now_ns: int) -> None:
        """Make the means of all intervals that are over and have none yet.

        A mean that was made while the clock was ahead holds up none of those before it.
        """
        for finer, step_s in pairwise(step.value for step in AveragingStep):
            with self._write() as session:
                one_at_a_time(session.connection(), AVERAGING)
                average_until(session, finer, step_s, now_ns=now_ns)

    def forget_measurements(self, step_s: int, rows: int, *, before_ns: int) -> DeletedRows:
        """Delete the oldest measurements of one step from before a time, but those in partitions.

        rows: about how many at most. Those of one time go together, so it may be one more for each motor.
        """
        name = DEFAULT if self._reading.dialect.name == "postgresql" else TABLE
        old = table(name, column("step_s", BigInteger), column("time_ns", BigInteger))
        of_step = old.c.step_s == step_s
        in_order = select(old.c.time_ns).where(of_step, old.c.time_ns < before_ns).order_by(old.c.time_ns)
        with self._read() as session:
            # Where the batch ends is looked up before it begins, while others may write.
            end_ns = session.scalar(in_order.offset(rows - 1).limit(1))
        if end_ns is None:
            end_ns = before_ns - 1
        # One bound only: of two, SQLite takes the first for the index, and reads all rows up to it.
        batch = delete(old).where(of_step, old.c.time_ns <= end_ns)
        with self._write() as session:
            connection = session.connection()
            began_s = monotonic()
            deleted = connection.execute(batch)
        return DeletedRows(deleted.rowcount, monotonic() - began_s)

    def measurements(
        self,
        motor: str,
        step_s: int,
        *,
        limit: int,
        from_ns: int | None = None,
        to_ns: int | None = None,
        after: Cursor | None = None,
    ) -> Page[Measurement]:
        """Return a motor's measurements, oldest first, from_ns <= time < to_ns. Raises NotFoundError."""
        query = select(*_MEASURED).where(MeasurementRow.motor == motor, MeasurementRow.step_s == step_s)
        query = query.where(*within(MeasurementRow.time_ns, from_ns, to_ns))
        order: Order = [MeasurementRow.time_ns]
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return page_of(session, query, order, _measurement, limit=limit, after=after)

    def measured_course(
        self, motor: str, step: AveragingStep, *, from_ns: int, to_ns: int, pieces: int
    ) -> tuple[Measurement, ...]:
        """Return what a motor's relay measured, from_ns <= time < to_ns, as means of so many pieces of time.

        Each stands at the first measurement in it; pieces without any are left out.
        """
        width_ns = max(1, -(-(to_ns - from_ns) // pieces))
        first_ns = func.min(MeasurementRow.time_ns)
        query = (
            select(
                first_ns,
                func.sum(MeasurementRow.samples),
                func.max(MeasurementRow.source),
                *map(_of_an_interval, _COLUMNS),
            )
            .where(MeasurementRow.motor == motor, MeasurementRow.step_s == step.value)
            .where(*within(MeasurementRow.time_ns, from_ns, to_ns))
            .group_by((MeasurementRow.time_ns - from_ns) // width_ns)
            .order_by(first_ns)
        )
        with self._read() as session:
            return tuple(_measurement(*row) for row in session.execute(query))


def insert_samples(session: Session, samples: Iterable[Sample], source: MeasurementSource) -> None:
    """Write samples at times that have none."""
    session.connection().execute(
        insert(MeasurementRow),
        [
            {
                "motor": sample.motor,
                "step_s": AveragingStep.AS_SAMPLED.value,
                "time_ns": sample.time_ns,
                "samples": 1,
                "source": source,
                **dict.fromkeys(quantity.value for quantity in MeteredQuantity),
                **sample.values,
            }
            for sample in samples
        ],
    )


def end_of_averages(step_s: int, now_ns: int) -> int:
    """Return the end of the latest interval of a step that is over."""
    step_ns = step_s * NANOSECONDS_PER_SECOND
    return (now_ns - LATENESS_NS) // step_ns * step_ns


def average_until(session: Session, finer: int, step_s: int, *, now_ns: int) -> None:
    """Make the means of the intervals of one step that are over, from behind the latest mean on."""
    to_ns = end_of_averages(step_s, now_ns)
    latest = session.scalar(
        select(func.max(MeasurementRow.time_ns)).where(
            MeasurementRow.step_s == step_s, MeasurementRow.time_ns < to_ns
        )
    )
    from_ns = 0 if latest is None else latest + step_s * NANOSECONDS_PER_SECOND
    if from_ns < to_ns:
        insert_means(session, finer, step_s, from_ns, to_ns)


def insert_means(
    session: Session, finer: int, step_s: int, from_ns: int, to_ns: int, *, of_load_profile: str | None = None
) -> None:
    """Store the means of the rows of step `finer` in [from_ns, to_ns), weighted with their samples.

    of_load_profile: a motor; only of its load profile's rows, and only means that are not there.
    """
    interval = {"of_step": step_s, "of_step_ns": step_s * NANOSECONDS_PER_SECOND}
    span = {"finer": finer, "from_ns": from_ns, "to_ns": to_ns}
    motor = {} if of_load_profile is None else {"of_motor": of_load_profile}
    statement = _means_inserted(of_load_profile=of_load_profile is not None)
    session.connection().execute(statement, interval | span | motor)


@cache
def _means_inserted(*, of_load_profile: bool) -> Insert:
    """Return the statement of `insert_means`. To put it together takes longer than to carry it out."""
    step_s, step_ns = bindparam("of_step", type_=Integer), bindparam("of_step_ns", type_=BigInteger)
    begin = (MeasurementRow.time_ns - MeasurementRow.time_ns % step_ns).label("begin")
    means = (
        select(
            MeasurementRow.motor,
            step_s,
            begin,
            func.sum(MeasurementRow.samples),
            func.max(MeasurementRow.source),
            *(_of_an_interval(quantity) for quantity in MeteredQuantity),
        )
        .where(
            MeasurementRow.step_s == bindparam("finer"),
            MeasurementRow.time_ns >= bindparam("from_ns"),
            MeasurementRow.time_ns < bindparam("to_ns"),
        )
        .group_by(MeasurementRow.motor, begin)
    )
    if of_load_profile:
        mean = aliased(MeasurementRow)
        is_there = exists().where(
            mean.motor == MeasurementRow.motor, mean.step_s == step_s, mean.time_ns == begin.element
        )
        means = means.where(
            MeasurementRow.motor == bindparam("of_motor"),
            MeasurementRow.source == MeasurementSource.LOAD_PROFILE,
            ~is_there,
        )
    names = ["motor", "step_s", "time_ns", "samples", "source", *MeteredQuantity]
    return insert(MeasurementRow).from_select(names, means)


def _of_an_interval(quantity: MeteredQuantity) -> ColumnElement[Any]:
    """Return the mean, weighted with samples; for a relay's own extremes, the largest or smallest."""
    column = _COLUMNS[quantity]
    if quantity.is_maximum:
        return func.max(column)
    if quantity.is_minimum:
        return func.min(column)
    weight = case((column.is_not(None), MeasurementRow.samples), else_=0)
    return func.sum(column * MeasurementRow.samples) / func.nullif(func.sum(weight), 0)


def _measurement(time_ns: int, samples: int, source: MeasurementSource, *values: float | None) -> Measurement:
    return Measurement(time_ns, samples, dict(zip(_NAMES, values, strict=True)), source)
