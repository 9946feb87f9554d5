"""Whether the wall clock of this host can be trusted, by comparison with the monotonic clock.

The age of stored values is measured by the wall clock. Somebody may set that clock a day ahead and correct it
minutes later; nothing may be deleted in between.
"""

from core.units import NANOSECONDS_PER_SECOND

SETTLING_S = 3600.0
"""A clock that was not set for this long is taken to be right."""

LARGEST_STEP_S = 5.0
"""Between two comparisons. Network time synchronisation slews a clock, or steps it by less."""


class WallClock:
    """Notices when the wall clock is set. For use by one thread.

    It knows only what it sees at each comparison: a clock that is set and set back between two of them counts
    as right.

    was_set: whether the clock was set less than SETTLING_S ago.
    is_settled: whether the clock has been compared for SETTLING_S and was not set in that time.
    """

    def __init__(self) -> None:
        self._lead_ns: int | None = None
        self._since_ns = 0
        self._steps = 0
        self.was_set = False
        self.is_settled = False

    def compare(self, wall_ns: int, monotonic_ns: int) -> None:
        """Take what both clocks show now [ns]."""
        lead_ns = wall_ns - monotonic_ns
        if self._lead_ns is None:
            self._since_ns = monotonic_ns
        elif abs(lead_ns - self._lead_ns) > LARGEST_STEP_S * NANOSECONDS_PER_SECOND:
            self._since_ns = monotonic_ns
            self._steps += 1
        self._lead_ns = lead_ns
        self.is_settled = monotonic_ns - self._since_ns >= SETTLING_S * NANOSECONDS_PER_SECOND
        self.was_set = self._steps > 0 and not self.is_settled
