"""The days of each motor's condition: kept in the transaction of a fold, read for overviews of the plant."""

from collections import defaultdict
from collections.abc import Collection, Mapping

from sqlalchemy import ColumnElement, delete, func, insert, select
from sqlalchemy.orm import InstrumentedAttribute, Session

from core.units import NANOSECONDS_PER_DAY
from service.storage.models import ConditionDayRow, ObservationRow
from service.storage.records import ConditionDay
from service.storage.repository.sessions import NONE_HELD, Sessions, columns_of


class ConditionDayRows(Sessions):
    def condition_days(
        self, motors: Collection[str], *, from_ns: int
    ) -> Mapping[str, tuple[ConditionDay, ...]]:
        """Return the days of these motors that have records, oldest first, from that of a time on.

        A motor without any is not among them.
        """
        days: dict[str, list[ConditionDay]] = defaultdict(list)
        with self._read() as session:
            names = sorted(motors)
            for first in range(0, len(names), MOTORS_A_STATEMENT):
                some = names[first : first + MOTORS_A_STATEMENT]
                query = (
                    select(ConditionDayRow.motor, *columns_of(ConditionDay, ConditionDayRow))
                    .where(ConditionDayRow.motor.in_(some), ConditionDayRow.day_ns >= _begin_of_day(from_ns))
                    .order_by(ConditionDayRow.motor, ConditionDayRow.day_ns)
                )
                for motor, *figures in session.execute(query):
                    days[motor].append(ConditionDay(*figures))
        return {motor: tuple(found) for motor, found in days.items()}


MOTORS_A_STATEMENT = 500
"""Databases limit how many values a statement may hold."""


def keep_days(session: Session, motor: str, *, after_ns: int | None, before_ns: int | None) -> None:
    """Make the days anew that have anything of the times between, whose records were folded.

    None: from the first record on, or up to the last.
    """
    of_days = [ConditionDayRow.motor == motor]
    of_records = [ObservationRow.motor == motor, ObservationRow.state.is_not(None)]
    if after_ns is not None:
        from_ns = _begin_of_day(after_ns)
        of_days.append(ConditionDayRow.day_ns >= from_ns)
        of_records.append(ObservationRow.time_ns >= from_ns)
    if before_ns is not None:
        end_ns = _begin_of_day(before_ns) + NANOSECONDS_PER_DAY
        of_days.append(ConditionDayRow.day_ns < end_ns)
        of_records.append(ObservationRow.time_ns < end_ns)
    day_ns = _day_of(ObservationRow.time_ns).label("of_day")
    level = ObservationRow.mu_f
    days = (
        select(ObservationRow.motor, day_ns, func.count(), func.min(level), func.avg(level), func.max(level))
        .where(*of_records)
        .group_by(ObservationRow.motor, day_ns)
    )
    columns = ["motor", "day_ns", "records", "mu_f_least", "mu_f_mean", "mu_f_largest"]
    session.execute(delete(ConditionDayRow).where(*of_days), execution_options=NONE_HELD)
    session.execute(insert(ConditionDayRow).from_select(columns, days))


def _begin_of_day(time_ns: int) -> int:
    return time_ns - time_ns % NANOSECONDS_PER_DAY


def _day_of(time_ns: InstrumentedAttribute[int]) -> ColumnElement[int]:
    """Return the same in SQL, where the remainder of a time before 1970 is negative."""
    day_ns = NANOSECONDS_PER_DAY
    return time_ns - (time_ns % day_ns + day_ns) % day_ns
