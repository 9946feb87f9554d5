"""When a motor's condition is stale: its latest valid record is older than the next ones were due."""

from enum import StrEnum
from functools import lru_cache

from core.condition.assessment import STALE_AFTER_NS
from core.units import NANOSECONDS_PER_DAY
from service.plant import Schedule
from service.storage.records import ConditionEntry

PAUSES = 2.5
"""Two records of a schedule may fail. A condition that misses more is stale."""

LOOKED_AT_NS = 8 * NANOSECONDS_PER_DAY
"""The longest pause of a schedule is looked for in a week."""

LOOKED_AT = 13
"""And among so many due times, such as those of a year in which each month has one."""


class Missing(StrEnum):
    """Why there is no recent record of a motor."""

    STALE = "stale"
    """What the last one told, if there is any, is too old to rely on."""
    NOT_RUNNING = "not-running"
    """It was seen to stand after its latest record, so that there can be none."""


def missing(as_of_ns: int | None, stood_ns: int | None, now_ns: int, oldest_ns: int) -> Missing | None:
    """Return why there is no recent record; None where there is one, or the motor was never seen.

    as_of_ns: latest record that counts.  stood_ns: when it was seen to stand last.  oldest_ns: age beyond
    which either is too old.
    """
    seen_ns = [time_ns for time_ns in (as_of_ns, stood_ns) if time_ns is not None]
    if not seen_ns:
        return None
    if now_ns - max(seen_ns) > oldest_ns:
        return Missing.STALE
    stands = stood_ns is not None and (as_of_ns is None or stood_ns > as_of_ns)
    return Missing.NOT_RUNNING if stands else None


def stale_after_ns(schedule: str | None, stale_after_days: float | None = None) -> int:
    """Return the age of the latest valid record beyond which a motor's condition is stale [ns].

    schedule: the motor's, a cron expression; a motor without one has a week.  stale_after_days: what the
    settings say instead. Raises ValueError for what is no schedule.
    """
    if stale_after_days is not None:
        return round(stale_after_days * NANOSECONDS_PER_DAY)
    return STALE_AFTER_NS if schedule is None else round(PAUSES * _longest_pause_ns(schedule))


def is_stale(entry: ConditionEntry, now_ns: int, oldest_ns: int) -> bool:
    """Tell whether the latest record of a condition is older than `oldest_ns`, or there is none.

    A motor that stands makes no record that counts: what was known of it when it stopped is not stale.
    """
    if entry.as_of_ns is None:
        return True
    return now_ns - max(entry.as_of_ns, entry.stood_ns or entry.as_of_ns) > oldest_ns


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
