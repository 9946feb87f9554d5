"""Times of relays' clocks in reports, as UTC; none of them lies ahead."""

from typing import Final
from zoneinfo import ZoneInfo

from core.recordings.local_time import utc_of
from core.units import NANOSECONDS_PER_DAY
from service.api.context import ApiContext

AHEAD_NS: Final = NANOSECONDS_PER_DAY
"""No relay's clock is so far ahead of the time; a date that is was read in the wrong order."""
LATER: Final = "expected a time that has been, found a later one: see date_order, and the relay's clock"


class RelayClock:
    """The clock of a motor's relay. now_ns: the time of the service."""

    def __init__(self, context: ApiContext, motor: str, now_ns: int) -> None:
        self._zone = ZoneInfo(context.time_zones.get(motor, "UTC"))
        self._now_ns = now_ns

    def utc_ns(self, time_ns: int) -> int:
        """Return a time of the clock in UTC."""
        return utc_of(time_ns, self._zone).ns

    def is_ahead(self, utc_ns: int) -> bool:
        """Tell whether a time is later than any clock's error can make it."""
        return utc_ns > self._now_ns + AHEAD_NS
