"""Which times of records may be true: a relay's clock that is years off would spoil its motor's condition.

The condition follows the records in their order of time. One record of a later century makes all that come
after it late, and the motor's condition never stale.
"""

from core.time_stamps import MAX_NS, nanoseconds, rfc3339
from core.units import NANOSECONDS_PER_DAY

EARLIEST_RECORD_NS = nanoseconds("2000-01-01T00:00:00Z")
"""Clocks without a battery begin in 1970, 1980 or 1984."""

FURTHEST_AHEAD_NS = NANOSECONDS_PER_DAY
"""A relay that keeps local time is hours ahead."""


class ImpossibleTimeError(ValueError):
    """The time of a record cannot be true."""


def require_possible_time(time_ns: int, now_ns: int) -> None:
    """Raise ImpossibleTimeError for the time of a record that cannot be true. now_ns: the service's clock."""
    if time_ns < EARLIEST_RECORD_NS:
        wrong = "before the year 2000"
    elif time_ns > now_ns + FURTHEST_AHEAD_NS:
        wrong = "more than a day ahead of the service's clock"
    else:
        return
    told = rfc3339(time_ns) if abs(time_ns) <= MAX_NS else f"{time_ns:.3g} ns"
    raise ImpossibleTimeError(
        f"the record's time is {told}, {wrong}: set the relay's clock; the record is left out of"
        " the motor's condition"
    )
