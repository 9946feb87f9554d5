"""The driven machine: its load torque over the rated one, how it pulsates, and its inertia."""

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class LoadCycle:
    """Levels that repeat: points (time [s] since the cycle's beginning, level), joined by lines.

    The first point is at 0; at `period_s` the cycle begins anew. Two points close together make a step.
    """

    points: tuple[tuple[float, float], ...]
    period_s: float


@dataclass(frozen=True, slots=True)
class Pulsation:
    """A torque that swings by `depth` of the rated torque with the cosine of an angle.

    The angle grows with time (`frequency_Hz`), with the shaft (`per_turn` swings a turn: a compressor's
    strokes, less than one for a belt that passes round less often), or twice as fast as the field runs ahead
    of the rotor (`twice_slip`): a swing at 2 s f that keeps step with that of a broken bar.
    """

    depth: float
    frequency_Hz: float = 0.0
    per_turn: float = 0.0
    twice_slip: bool = False

    def angle(self, time_s: Array, supply_angle: Array) -> Array:
        """Return the part of its angle that depends on time alone [rad], shape (n,).

        `supply_angle` is that of the voltage's fundamental at the times.
        """
        return 2 * pi * self.frequency_Hz * time_s + (2 * supply_angle if self.twice_slip else 0.0)

    def order(self, pole_pairs: int, direction: int) -> float:
        """Return how much its angle grows with the rotor's electrical angle."""
        return direction * (self.per_turn / pole_pairs - (2 if self.twice_slip else 0))


@dataclass(frozen=True, slots=True)
class Load:
    """A load level (1 = rated power P_B at synchronous speed) that swings by `swing` about its mean.

    A `cycle` replaces `level`; the swing is added to it. `pulsations` are added to the torque but not to the
    level. `inertia_kgm2` is added to that of the motor's parameters.
    """

    level: float
    swing: float = 0.0
    swing_period_s: float = 20.0
    cycle: LoadCycle | None = None
    pulsations: tuple[Pulsation, ...] = ()
    inertia_kgm2: float = 0.0

    def level_at(self, time_s: float) -> float:
        """Return the load level at one time [s]."""
        return float(self.levels(np.array([time_s]))[0])

    def levels(self, time_s: Array) -> Array:
        """Return the load level at the times [s], same shape."""
        swing = self.swing * np.sin(2 * pi * time_s / self.swing_period_s)
        if self.cycle is None:
            levels: Array = self.level + swing
            return levels
        at_s, level = np.array(self.cycle.points).T
        cycled: Array = np.interp(time_s, at_s, level, period=self.cycle.period_s) + swing
        return cycled
