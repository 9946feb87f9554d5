"""Partitions of the measured values on PostgreSQL: a table for each step and period of time.

    measurements                      by step and time
        measurements_default          what has no partition (yet): no insert fails
        measurements_0_2026_11_25     samples of a day
        measurements_60_2026_11       means of a minute, of a month
        measurements_900_2026_11      means of a quarter of an hour, of a month

Samples are kept for a day and means for years: in tables by time alone, the room of a month's samples would
stay with its few means for years. SQLite has one table, and nothing here is for it.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

from sqlalchemy import Connection, text

from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.plant import AveragingStep

TABLE = "measurements"
DEFAULT = "measurements_default"

AHEAD_NS = 3 * NANOSECONDS_PER_DAY
"""A partition is made so long before its first row can come."""

MOST_PARTITIONS = 400
"""Of one step: each costs a question about all of the time. What has none stays in the default one."""

LOCK_TIMEOUT = "2s"
"""Others wait behind a change of the partitions that waits itself: it gives up, and comes again."""

_NAME = re.compile(rf"{TABLE}_(?P<step>\d+)_(?P<begin>\d{{4}}_\d\d(?:_\d\d)?)")


@dataclass(frozen=True, slots=True, order=True)
class Period:
    """A time of which one partition has the rows of one step: begin_ns <= time < end_ns."""

    step_s: int
    begin_ns: int
    end_ns: int

    @property
    def name(self) -> str:
        begin = datetime.fromtimestamp(self.begin_ns // NANOSECONDS_PER_SECOND, UTC)
        day = f"_{begin.day:02d}" if self.step_s == AveragingStep.AS_SAMPLED else ""
        return f"{TABLE}_{self.step_s}_{begin.year:04d}_{begin.month:02d}{day}"

    @classmethod
    def at(cls, step_s: int, time_ns: int) -> "Period":
        """Return the period with a time: a day of samples, a month of means, both of UTC."""
        day = datetime.fromtimestamp(time_ns // NANOSECONDS_PER_SECOND, UTC).replace(
            hour=0, minute=0, second=0
        )
        if step_s == AveragingStep.AS_SAMPLED:
            return cls(step_s, _ns(day), _ns(day + timedelta(days=1)))
        first = day.replace(day=1)
        return cls(step_s, _ns(first), _ns((first + timedelta(days=31)).replace(day=1)))

    @classmethod
    def named(cls, name: str) -> "Period | None":
        """Return the period of a partition; None where it is not one of a period."""
        found = _NAME.fullmatch(name)
        if found is None:
            return None
        year, month, day = (*map(int, found["begin"].split("_")), 1)[:3]
        return cls.at(int(found["step"]), _ns(datetime(year, month, day, tzinfo=UTC)))


def partitions(connection: Connection) -> Sequence[str]:
    """Return the names of all partitions of the database, to tell them from its tables; none on SQLite."""
    if connection.dialect.name != "postgresql":
        return ()
    query = text(
        "SELECT relname FROM pg_class WHERE relispartition AND relkind IN ('r', 'p')"
        " AND relnamespace = current_schema()::regnamespace"
    )
    return connection.scalars(query).all()


def periods(connection: Connection) -> Iterator[Period]:
    """Yield the periods that have a partition."""
    for name in partitions(connection):
        period = Period.named(name)
        if period is not None:
            yield period


def wanted(now_ns: int) -> Iterator[Period]:
    """Yield the periods that need a partition at a time: the one under way, and the next if it is near."""
    for step in AveragingStep:
        yield from sorted({Period.at(step.value, now_ns), Period.at(step.value, now_ns + AHEAD_NS)})
        if step is AveragingStep.AS_SAMPLED:
            days = range(1, AHEAD_NS // NANOSECONDS_PER_DAY)
            yield from (Period.at(step.value, now_ns + day * NANOSECONDS_PER_DAY) for day in days)


def waiting(connection: Connection) -> Iterator[Period]:
    """Yield the periods that have rows in the default partition; the index of their times finds each."""
    for step in AveragingStep:
        after_ns: int | None = None
        while True:
            earliest = text(
                f"SELECT min(time_ns) FROM {DEFAULT} WHERE step_s = :step"  # noqa: S608 - own names
                + ("" if after_ns is None else " AND time_ns >= :after")
            )
            time_ns = connection.scalar(earliest, {"step": step.value, "after": after_ns})
            if time_ns is None:
                break
            period = Period.at(step.value, time_ns)
            yield period
            after_ns = period.end_ns


def make(connection: Connection, new: Iterable[Period]) -> Sequence[Period]:
    """Make the partitions of these periods that are missing, with rows of the default one; return them.

    Raises sqlalchemy.exc.OperationalError where others use the table for longer than LOCK_TIMEOUT.
    """
    present = set(periods(connection))
    missing = _fewest(present, set(new) - present)
    if not missing:
        return ()
    _limit_wait(connection)
    # Nobody may add a row of a period to the default partition before the new one is there.
    connection.execute(text(f"LOCK TABLE {DEFAULT} IN SHARE ROW EXCLUSIVE MODE"))
    for period in missing:
        bounds = {"step": period.step_s, "begin": period.begin_ns, "end": period.end_ns}
        connection.execute(text(f"CREATE TABLE {period.name} (LIKE {DEFAULT} INCLUDING DEFAULTS)"))
        connection.execute(
            text(
                f"WITH moved AS (DELETE FROM {DEFAULT} WHERE step_s = :step AND time_ns >= :begin"  # noqa: S608
                f" AND time_ns < :end RETURNING *) INSERT INTO {period.name} SELECT * FROM moved"
            ),
            bounds,
        )
    for period in missing:
        connection.execute(
            text(
                f"ALTER TABLE {TABLE} ATTACH PARTITION {period.name} FOR VALUES FROM"
                f" ({period.step_s}, {period.begin_ns}) TO ({period.step_s}, {period.end_ns})"
            )
        )
    return missing


def drop(connection: Connection, step_s: int, *, before_ns: int) -> Sequence[Period]:
    """Drop the partitions of a step whose period has ended before a time; return them.

    Raises sqlalchemy.exc.OperationalError where others use the table for longer than LOCK_TIMEOUT.
    """
    past = sorted(one for one in periods(connection) if one.step_s == step_s and one.end_ns <= before_ns)
    if past:
        _limit_wait(connection)
        connection.execute(text(f"DROP TABLE {', '.join(one.name for one in past)}"))
    return past


def _fewest(present: set[Period], missing: set[Period]) -> Sequence[Period]:
    """Return as many of the missing ones as each step may still have, the latest first."""
    taken: list[Period] = []
    for step in AveragingStep:
        room = MOST_PARTITIONS - sum(one.step_s == step for one in present)
        of_step = sorted((one for one in missing if one.step_s == step), reverse=True)
        taken += of_step[: max(0, room)]
    return taken


def _limit_wait(connection: Connection) -> None:
    connection.execute(text(f"SET LOCAL lock_timeout = '{LOCK_TIMEOUT}'"))


def _ns(time: datetime) -> int:
    return int(time.timestamp()) * NANOSECONDS_PER_SECOND
