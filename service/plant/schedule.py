"""When a motor is recorded regularly: a cron expression, in UTC."""

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Self

from cronsim import CronSim, CronSimError

from core.units import NANOSECONDS_PER_SECOND

FIELDS = 5


@dataclass(frozen=True, slots=True)
class Schedule:
    """`expression`: minute, hour, day of the month, month, day of the week, as in cron; times are UTC.

    only_running: whether a motor that stands when it is due is left alone.
    """

    expression: str
    only_running: bool = False

    @classmethod
    def parse(cls, expression: str, *, only_running: bool = False) -> Self:
        """Read a cron expression. Raises ValueError with what was expected."""
        words = expression.split()
        if len(words) != FIELDS:
            raise ValueError(f"{FIELDS} fields (minute, hour, day of the month, month, day of the week)")
        schedule = cls(" ".join(words), only_running)
        try:
            schedule.next_after(0)
        except CronSimError as error:
            raise ValueError(f"a cron expression such as '30 6 * * MON' ({error})") from error
        except StopIteration as error:
            raise ValueError("a cron expression that some day comes true") from error
        return schedule

    def in_words(self) -> str:
        """Return when that is: "every minute", "at 06:00 every day (UTC)"."""
        words = CronSim(self.expression, datetime(2000, 1, 1, tzinfo=UTC)).explain()
        zone = " (UTC)" if any(letter.isdigit() for letter in words) else ""
        return f"{words[:1].lower()}{words[1:]}{zone}"

    def next_after(self, time_ns: int) -> int:
        """Return the first time later than `time_ns` [ns UTC]."""
        return next(self.times_after(time_ns))

    def times_after(self, time_ns: int) -> Iterator[int]:
        """Yield the times later than `time_ns`, in their order [ns UTC]."""
        after = datetime.fromtimestamp(time_ns // NANOSECONDS_PER_SECOND, UTC)
        for due in CronSim(self.expression, after):
            yield int(due.timestamp()) * NANOSECONDS_PER_SECOND
