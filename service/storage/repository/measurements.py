"""Measured values over time: as sampled for a while, as means of minutes and quarters of an hour later."""

from collections.abc import Iterable
from itertools import pairwise
from time import monotonic
from typing import Any

from sqlalchemy import ColumnElement, bindparam, case, delete, func, insert, literal, select
from sqlalchemy.orm import Session

from core.units import NANOSECONDS_PER_SECOND
from service.plant import AveragingStep, MeteredQuantity
from service.storage.engine import one_at_a_time
from service.storage.models import MeasurementRow, MotorRow
from service.storage.records import Cursor, DeletedRows, Measurement, Page, Sample
from service.storage.repository.sessions import Order, Sessions, found, page_of, within

LATENESS_NS = 120 * NANOSECONDS_PER_SECOND
"""A mean is made when its interval ended this long ago: samples may be on their way until then."""

_COLUMNS = {quantity: MeasurementRow.__table__.c[quantity.value] for quantity in MeteredQuantity}

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
            connection = session.connection()
            connection.execute(_OF_A_TIME, [{"of": motor, "at": time_ns} for motor, time_ns in latest])
            connection.execute(
                insert(MeasurementRow),
                [
                    {
                        "motor": sample.motor,
                        "step_s": AveragingStep.AS_SAMPLED.value,
                        "time_ns": sample.time_ns,
                        "samples": 1,
                        **dict.fromkeys(quantity.value for quantity in MeteredQuantity),
                        **sample.values,
                    }
                    for sample in latest.values()
                ],
            )

    def latest_sample(self, motor: str, *, since_ns: int) -> Measurement | None:
        """Return what a motor's relay measured last, from a time on; None without anything."""
        query = (
            select(MeasurementRow.time_ns, MeasurementRow.samples, *_COLUMNS.values())
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
                one_at_a_time(session.connection(), "average measurements")
                step_ns = step_s * NANOSECONDS_PER_SECOND
                to_ns = (now_ns - LATENESS_NS) // step_ns * step_ns
                latest = session.scalar(
                    select(func.max(MeasurementRow.time_ns)).where(
                        MeasurementRow.step_s == step_s, MeasurementRow.time_ns < to_ns
                    )
                )
                from_ns = 0 if latest is None else latest + step_ns
                _average(session, finer, step_s, from_ns, to_ns)

    def forget_measurements(self, step_s: int, rows: int, *, before_ns: int) -> DeletedRows:
        """Delete the oldest measurements of one step from before a time.

        rows: about how many at most. Those of one time go together, so it may be one more for each motor.
        """
        of_step = MeasurementRow.step_s == step_s
        in_order = (
            select(MeasurementRow.time_ns)
            .where(of_step, MeasurementRow.time_ns < before_ns)
            .order_by(MeasurementRow.time_ns)
        )
        with self._read() as session:
            # Where the batch ends is looked up before it begins, while others may write.
            end_ns = session.scalar(in_order.offset(rows - 1).limit(1))
        if end_ns is None:
            end_ns = before_ns - 1
        # One bound only: of two, SQLite takes the first for the index, and reads all rows up to it.
        batch = delete(MeasurementRow).where(of_step, MeasurementRow.time_ns <= end_ns)
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
        columns = (MeasurementRow.time_ns, MeasurementRow.samples, *_COLUMNS.values())
        query = select(*columns).where(MeasurementRow.motor == motor, MeasurementRow.step_s == step_s)
        query = query.where(*within(MeasurementRow.time_ns, from_ns, to_ns))
        order: Order = [MeasurementRow.time_ns]
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return page_of(session, query, order, _measurement, limit=limit, after=after)


def _average(session: Session, finer: int, step_s: int, from_ns: int, to_ns: int) -> None:
    """Store the means of the rows of step `finer` in [from_ns, to_ns), weighted with their samples."""
    step_ns = step_s * NANOSECONDS_PER_SECOND
    begin = (MeasurementRow.time_ns - MeasurementRow.time_ns % step_ns).label("begin")
    means = (
        select(
            MeasurementRow.motor,
            literal(step_s),
            begin,
            func.sum(MeasurementRow.samples),
            *(_of_an_interval(quantity) for quantity in MeteredQuantity),
        )
        .where(
            MeasurementRow.step_s == finer, MeasurementRow.time_ns >= from_ns, MeasurementRow.time_ns < to_ns
        )
        .group_by(MeasurementRow.motor, begin)
    )
    names = ["motor", "step_s", "time_ns", "samples", *MeteredQuantity]
    session.execute(insert(MeasurementRow).from_select(names, means))


def _of_an_interval(quantity: MeteredQuantity) -> ColumnElement[Any]:
    """Return the mean, weighted with samples; for a relay's own extremes, the largest or smallest."""
    column = _COLUMNS[quantity]
    if quantity.is_maximum:
        return func.max(column)
    if quantity.is_minimum:
        return func.min(column)
    weight = case((column.is_not(None), MeasurementRow.samples), else_=0)
    return func.sum(column * MeasurementRow.samples) / func.nullif(func.sum(weight), 0)


def _measurement(time_ns: int, samples: int, *values: float | None) -> Measurement:
    return Measurement(time_ns, samples, dict(zip(_NAMES, values, strict=True)))
