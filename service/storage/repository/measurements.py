"""Measured values over time: as sampled for a while, as means of minutes and quarters of an hour later."""

from collections.abc import Iterable
from itertools import pairwise

from sqlalchemy import ColumnElement, bindparam, case, delete, func, insert, literal, select
from sqlalchemy.orm import InstrumentedAttribute, Session

from service.storage.models import MeasurementRow, MotorRow
from service.storage.records import Cursor, Measurement, Page, Sample
from service.storage.repository.sessions import Order, Sessions, found, page_of, record_of

AS_SAMPLED = 0
STEPS_S = (AS_SAMPLED, 60, 900)
"""Each but the first is made of the one before it [s]."""

SECOND_NS = 1_000_000_000
LATENESS_NS = 120 * SECOND_NS
"""A mean is made when its interval ended this long ago: samples may be on their way until then."""

FIGURES: tuple[InstrumentedAttribute[float | None], ...] = (
    MeasurementRow.ia_A,
    MeasurementRow.ib_A,
    MeasurementRow.ic_A,
    MeasurementRow.vab_V,
    MeasurementRow.vbc_V,
    MeasurementRow.vca_V,
    MeasurementRow.va_V,
    MeasurementRow.vb_V,
    MeasurementRow.vc_V,
    MeasurementRow.power_W,
    MeasurementRow.reactive_power_var,
    MeasurementRow.power_factor,
    MeasurementRow.frequency_Hz,
    MeasurementRow.average_current_A,
    MeasurementRow.maximum_current_A,
    MeasurementRow.minimum_current_A,
    MeasurementRow.average_voltage_V,
    MeasurementRow.maximum_voltage_V,
    MeasurementRow.minimum_voltage_V,
    MeasurementRow.average_power_W,
    MeasurementRow.maximum_power_W,
    MeasurementRow.minimum_power_W,
    MeasurementRow.maximum_ia_A,
    MeasurementRow.maximum_ib_A,
    MeasurementRow.maximum_ic_A,
    MeasurementRow.minimum_ia_A,
    MeasurementRow.minimum_ib_A,
    MeasurementRow.minimum_ic_A,
    MeasurementRow.maximum_vab_V,
    MeasurementRow.maximum_vbc_V,
    MeasurementRow.maximum_vca_V,
    MeasurementRow.minimum_vab_V,
    MeasurementRow.minimum_vbc_V,
    MeasurementRow.minimum_vca_V,
)


NAMES = tuple(figure.key for figure in FIGURES)

_OF_A_TIME = delete(MeasurementRow).where(
    MeasurementRow.motor == bindparam("of"),
    MeasurementRow.step_s == AS_SAMPLED,
    MeasurementRow.time_ns == bindparam("at"),
)


class MeasurementRows(Sessions):
    def add_samples(self, samples: Iterable[Sample]) -> None:
        """Writes samples; a second one of a motor at the very same time replaces the first."""
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
                        "step_s": AS_SAMPLED,
                        "time_ns": sample.time_ns,
                        "samples": 1,
                        **dict.fromkeys(NAMES),
                        **sample.values,
                    }
                    for sample in latest.values()
                ],
            )

    def average_measurements(self, *, now_ns: int) -> None:
        """Makes the means of all intervals that are over and have none yet.

        A mean that a clock made while it was ahead holds up none of those before it.
        """
        for finer, step_s in pairwise(STEPS_S):
            with self._write() as session:
                step_ns = step_s * SECOND_NS
                to_ns = (now_ns - LATENESS_NS) // step_ns * step_ns
                latest = session.scalar(
                    select(func.max(MeasurementRow.time_ns)).where(
                        MeasurementRow.step_s == step_s, MeasurementRow.time_ns < to_ns
                    )
                )
                from_ns = 0 if latest is None else latest + step_ns
                _average(session, finer, step_s, from_ns, to_ns)

    def forget_measurements(self, step_s: int, *, before_ns: int) -> None:
        """Deletes those of one step from before a time."""
        with self._write() as session:
            session.execute(
                delete(MeasurementRow).where(
                    MeasurementRow.step_s == step_s, MeasurementRow.time_ns < before_ns
                )
            )

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
        """Of one motor, oldest first, from_ns <= time < to_ns. Raises NotFoundError."""
        query = select(MeasurementRow).where(MeasurementRow.motor == motor, MeasurementRow.step_s == step_s)
        if from_ns is not None:
            query = query.where(MeasurementRow.time_ns >= from_ns)
        if to_ns is not None:
            query = query.where(MeasurementRow.time_ns < to_ns)
        order: Order = [MeasurementRow.time_ns]
        with self._read() as session:
            found(session, MotorRow, motor, "motor")
            return page_of(session, query, order, _measurement, limit=limit, after=after)


def _average(session: Session, finer: int, step_s: int, from_ns: int, to_ns: int) -> None:
    """Means of the rows of step `finer` in [from_ns, to_ns), each row weighted with its samples."""
    step_ns = step_s * SECOND_NS
    begin = (MeasurementRow.time_ns - MeasurementRow.time_ns % step_ns).label("begin")
    means = (
        select(
            MeasurementRow.motor,
            literal(step_s),
            begin,
            func.sum(MeasurementRow.samples),
            *(_of_an_interval(figure) for figure in FIGURES),
        )
        .where(
            MeasurementRow.step_s == finer, MeasurementRow.time_ns >= from_ns, MeasurementRow.time_ns < to_ns
        )
        .group_by(MeasurementRow.motor, begin)
    )
    names = ["motor", "step_s", "time_ns", "samples", *(figure.key for figure in FIGURES)]
    session.execute(insert(MeasurementRow).from_select(names, means))


def _of_an_interval(figure: InstrumentedAttribute[float | None]) -> ColumnElement[float | None]:
    """The mean; of a relay's own maxima and minima, the largest and the smallest."""
    if figure.key.startswith("maximum_"):
        return func.max(figure)
    if figure.key.startswith("minimum_"):
        return func.min(figure)
    return _mean(figure)


def _mean(figure: InstrumentedAttribute[float | None]) -> ColumnElement[float | None]:
    weight = case((figure.is_not(None), MeasurementRow.samples), else_=0)
    return func.sum(figure * MeasurementRow.samples) / func.nullif(func.sum(weight), 0)


def _measurement(row: MeasurementRow) -> Measurement:
    return record_of(Measurement, row)
