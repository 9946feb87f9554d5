"""Whether this host's wall clock can be relied upon, told by the clock that only goes forward.

What is old is told by the wall clock, and somebody may set that a day ahead, and right again minutes later.
"""

from core.units import NANOSECONDS_PER_SECOND

SETTLING_S = 3600.0
"""A clock that was not set for so long is taken for right."""

LARGEST_STEP_S = 5.0
"""Between two looks. A clock that is kept right by the network is slewed, or set by less."""


class WallClock:
    """Used by one thread, which looks at it now and then; a clock that is set and set back between two looks
    was right at both.

    was_set: whether it was set less than SETTLING_S ago, as far as anybody looked.
    is_settled: whether it has been looked at for SETTLING_S and was not set.
    """

    def __init__(self) -> None:
        self._lead_ns: int | None = None
        self._since_ns = 0
        self._steps = 0
        self.was_set = False
        self.is_settled = False

    def look(self, wall_ns: int, monotonic_ns: int) -> None:
        """What both clocks say now [ns]."""
        lead_ns = wall_ns - monotonic_ns
        if self._lead_ns is None:
            self._since_ns = monotonic_ns
        elif abs(lead_ns - self._lead_ns) > LARGEST_STEP_S * NANOSECONDS_PER_SECOND:
            self._since_ns = monotonic_ns
            self._steps += 1
        self._lead_ns = lead_ns
        self.is_settled = monotonic_ns - self._since_ns >= SETTLING_S * NANOSECONDS_PER_SECOND
        self.was_set = self._steps > 0 and not self.is_settled
