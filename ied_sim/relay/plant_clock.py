"""The plant's clock: the real one, or one that lives through the past in leaps until it has caught up."""

import time
from dataclasses import dataclass

from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND


@dataclass(frozen=True, slots=True)
class ClockSettings:
    """How the plant's time runs.

    Parameters
    ----------
    start_days_ago : float
        The plant's time zero lies so long before the simulator's start.
    speed_up : float
        Its time runs so many times faster until it has caught up with the real one, then as that does.
    leap_every_s : float
        The clock does not run faster all the time: it runs as the real one for so long, then leaps. What is
        recorded between two leaps thus has its true length and its true distance in time.
    """

    start_days_ago: float = 0.0
    speed_up: float = 1.0
    leap_every_s: float = 5.0


REAL_TIME = ClockSettings()


class PlantClock:
    """UTC as the plant has it, in nanoseconds, where the simulator started at `start_ns`.

    Several threads may use it. Its times are behind the real ones, never ahead. Without a start in the past
    the two are the same.
    """

    def __init__(self, start_ns: int, settings: ClockSettings = REAL_TIME) -> None:
        self._start_ns = start_ns
        self._behind_ns = round(settings.start_days_ago * NANOSECONDS_PER_DAY)
        self._every_ns = round(settings.leap_every_s * NANOSECONDS_PER_SECOND)
        self._leap_ns = round(self._every_ns * (settings.speed_up - 1.0))
        self.epoch_ns = start_ns - self._behind_ns
        """UTC of the plant's time zero."""

    def now_ns(self) -> int:
        """Return the plant's present time."""
        return self.plant_ns(time.time_ns())

    def plant_ns(self, real_ns: int) -> int:
        """Return the plant's time at a real one."""
        return real_ns - self._behind_after((real_ns - self._start_ns) // self._every_ns)

    def running_s(self) -> float:
        """Return the real seconds since the simulator's start."""
        return (time.time_ns() - self._start_ns) / NANOSECONDS_PER_SECOND

    def real_ns(self, plant_ns: int) -> int:
        """Return when the plant's clock shows a time: at the leap where it leaps over it."""
        leaps, since_ns = divmod(plant_ns - self.epoch_ns, self._every_ns + self._leap_ns)
        if leaps < 0:
            return plant_ns + self._behind_ns
        # The plant is never ahead: where this comes out earlier, it has caught up by then.
        return max(plant_ns, self._start_ns + leaps * self._every_ns + min(since_ns, self._every_ns))

    def _behind_after(self, leaps: int) -> int:
        return max(0, self._behind_ns - max(0, leaps) * self._leap_ns)
