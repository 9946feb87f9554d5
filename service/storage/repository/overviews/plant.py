"""Motors with what the motors file says of them."""

from collections.abc import Collection, Sequence
from typing import Any

from sqlalchemy import func, select, tuple_

from service.plant import AveragingStep, MeteredQuantity
from service.storage.models import MeasurementRow, MotorRow, MotorVersionRow
from service.storage.records import Cursor, MotorEntry, Page, Sample
from service.storage.records.overviews import MotorOverview
from service.storage.repository.conditions.fold_marks import EARLIEST_NS
from service.storage.repository.sessions import Sessions, columns_of, page_of


class PlantOverviewRows(Sessions):
    def motor_overviews(
        self, *, limit: int, after: Cursor | None = None, site: str | None = None, text: str | None = None
    ) -> Page[MotorOverview]:
        """Return a page of the motors in service, by name, each with the latest version of its data.

        site: only motors there. text: only those whose name, or their relay's, has it in it; None for all.
        """
        query = select(*columns_of(MotorEntry, MotorRow), MotorRow.bus).where(MotorRow.in_service)
        if site is not None:
            query = query.where(MotorRow.site == site)
        if text is not None:
            query = query.where(
                MotorRow.name.icontains(text, autoescape=True) | MotorRow.ied.icontains(text, autoescape=True)
            )
        with self._read() as session:
            motors = page_of(session, query, [MotorRow.name], _row, limit=limit, after=after)
            names = [motor.name for motor, _bus in motors.items]
            newest = (
                select(MotorVersionRow.motor, func.max(MotorVersionRow.from_ns))
                .where(MotorVersionRow.motor.in_(names))
                .group_by(MotorVersionRow.motor)
            )
            key = tuple_(MotorVersionRow.motor, MotorVersionRow.from_ns)
            versions = {
                row.motor: row for row in session.scalars(select(MotorVersionRow).where(key.in_(newest)))
            }
            return Page(
                tuple(_overview(motor, bus, versions.get(motor.name)) for motor, bus in motors.items),
                motors.next,
            )

    def latest_samples(self, motors: Collection[str], *, since_ns: int) -> dict[str, Sample]:
        """Return what the relay of each motor measured last, from a time on; without those that have nothing.

        The primary key finds each motor's latest.
        """
        as_sampled = MeasurementRow.step_s == AveragingStep.AS_SAMPLED.value
        newest = (
            select(MeasurementRow.motor, func.max(MeasurementRow.time_ns))
            .where(MeasurementRow.motor.in_(motors), as_sampled, MeasurementRow.time_ns >= since_ns)
            .group_by(MeasurementRow.motor)
        )
        columns = [getattr(MeasurementRow, quantity.value) for quantity in MeteredQuantity]
        key = tuple_(MeasurementRow.motor, MeasurementRow.time_ns)
        query = select(MeasurementRow.motor, MeasurementRow.time_ns, *columns).where(
            as_sampled, key.in_(newest)
        )
        with self._read() as session:
            return {
                motor: Sample(motor, time_ns, _known(values))
                for motor, time_ns, *values in session.execute(query)
            }


def _known(values: Sequence[float | None]) -> dict[str, float]:
    named = zip(MeteredQuantity, values, strict=True)
    return {quantity.value: value for quantity, value in named if value is not None}


def _row(*columns: Any) -> tuple[MotorEntry, str | None]:
    return MotorEntry(*columns[:-1]), columns[-1]


def _overview(motor: MotorEntry, bus: str | None, version: MotorVersionRow | None) -> MotorOverview:
    if version is None:
        return MotorOverview(motor, bus, None, None)
    since_ns = None if version.from_ns == EARLIEST_NS else version.from_ns
    return MotorOverview(motor, bus, version.document, since_ns)
