"""The driven machine: how much of the rated torque it asks for, as a function of time alone."""

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Load:
    """A load level (1 = rated power P_B at synchronous speed) that swings by `swing` about its mean."""

    level: float
    swing: float = 0.0
    swing_period_s: float = 20.0

    def level_at(self, time_s: float) -> float:
        """Load level at one time [s]."""
        return float(self.levels(np.array([time_s]))[0])

    def levels(self, time_s: NDArray[np.float64]) -> NDArray[np.float64]:
        """Load level at the times [s], same shape."""
        return self.level + self.swing * np.sin(2 * pi * time_s / self.swing_period_s)
