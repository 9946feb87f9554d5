"""A text report as it was brought: its times are of the relay's clock, and none of them lies ahead."""

from dataclasses import dataclass
from typing import Final
from zoneinfo import ZoneInfo

from core.recordings.local_time import utc_of
from core.relay_reports.clock_times import DateOrder
from core.units import NANOSECONDS_PER_DAY
from service.plant import PowerUnit
from service.storage.records import Actor

AHEAD_NS: Final = NANOSECONDS_PER_DAY
"""No relay's clock is so far ahead of the time; a date that is was read in the wrong order."""
LATER: Final = "expected a time that has been, found a later one: see date_order, and the relay's clock"


@dataclass(frozen=True, slots=True)
class BroughtReport:
    """A report of a motor's relay.

    zone: that of the relay's clock.  power_unit: of a load profile; None where nobody said it.
    by, now_ns: who brought it, and when; None where the service fetched it from the relay, which leaves no
    entry in the audit trail, as recordings leave none.
    """

    text: bytes
    date_order: DateOrder
    power_unit: PowerUnit | None
    zone: ZoneInfo
    by: Actor | None
    now_ns: int

    def utc_ns(self, time_ns: int) -> int:
        """Return a time of the relay's clock in UTC."""
        return utc_of(time_ns, self.zone).ns

    def is_ahead(self, utc_ns: int) -> bool:
        """Tell whether a time is later than any clock's error can make it."""
        return utc_ns > self.now_ns + AHEAD_NS
