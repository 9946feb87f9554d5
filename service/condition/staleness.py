"""When a motor's condition is stale: its latest valid record is older than the next ones were due."""

from functools import lru_cache

from core.condition.assessment import STALE_AFTER_NS
from core.units import NANOSECONDS_PER_DAY
from service.plant import Schedule

PAUSES = 2.5
"""Two records of a schedule may fail. A condition that misses more is stale."""

LOOKED_AT_NS = 8 * NANOSECONDS_PER_DAY
"""The longest pause of a schedule is looked for in a week."""

LOOKED_AT = 13
"""And among so many due times, such as those of a year in which each month has one."""


def stale_after_ns(schedule: str | None, stale_after_days: float | None = None) -> int:
    """Return the age of the latest valid record beyond which a motor's condition is stale [ns].

    schedule: the motor's, a cron expression; a motor without one has a week.  stale_after_days: what the
    settings say instead. Raises ValueError for what is no schedule.
    """
    if stale_after_days is not None:
        return round(stale_after_days * NANOSECONDS_PER_DAY)
    return STALE_AFTER_NS if schedule is None else round(PAUSES * _longest_pause_ns(schedule))


@lru_cache(maxsize=1000)
def _longest_pause_ns(schedule: str) -> int:
    longest_ns, number, before_ns = 0, 0, None
    for due_ns in Schedule.parse(schedule).times_after(0):
        if before_ns is not None:
            longest_ns = max(longest_ns, due_ns - before_ns)
        number, before_ns = number + 1, due_ns
        if number >= LOOKED_AT and due_ns >= LOOKED_AT_NS:
            break
    return longest_ns
