"""The driven machine: its load torque over the rated one, as a function of time alone."""

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class LoadCycle:
    """Levels that repeat: points (time [s] since the cycle's beginning, level), joined by lines.

    The first point is at 0; at `period_s` the cycle begins anew. Two points close together make a step.
    """

    points: tuple[tuple[float, float], ...]
    period_s: float


@dataclass(frozen=True, slots=True)
class Load:
    """A load level (1 = rated power P_B at synchronous speed) that swings by `swing` about its mean.

    A `cycle` replaces `level`; the swing is added to it.
    """

    level: float
    swing: float = 0.0
    swing_period_s: float = 20.0
    cycle: LoadCycle | None = None

    def level_at(self, time_s: float) -> float:
        """Return the load level at one time [s]."""
        return float(self.levels(np.array([time_s]))[0])

    def levels(self, time_s: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the load level at the times [s], same shape."""
        swing = self.swing * np.sin(2 * pi * time_s / self.swing_period_s)
        if self.cycle is None:
            levels: NDArray[np.float64] = self.level + swing
            return levels
        at_s, level = np.array(self.cycle.points).T
        cycled: NDArray[np.float64] = np.interp(time_s, at_s, level, period=self.cycle.period_s) + swing
        return cycled
