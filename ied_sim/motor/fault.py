"""Shorted stator turns: their state at one moment, and how they develop."""

from dataclasses import dataclass
from itertools import pairwise

NEGLIGIBLE_LEVEL = 1e-5
"""Equivalent level below which a fault draws less than the noise and would only stiffen the equations."""


@dataclass(frozen=True, slots=True)
class TurnFault:
    """A path of `resistance_ohm` across the fraction `turns` (mu) of the turns of phase 0, 1 or 2 (a, b, c).

    In a delta motor phase a is the winding between terminals a and b.
    """

    turns: float
    phase: int
    resistance_ohm: float = 0.0

    def equivalent_level(self, stator_resistance_ohm: float) -> float:
        """Return the level mu_eq of the bolted short that draws the same current.

        mu_eq = R_s / (r_f / mu^2 + R_s / mu).
        """
        if self.turns == 0:
            return 0.0
        return self.turns / (1 + self.resistance_ohm / (self.turns * stator_resistance_ohm))


@dataclass(frozen=True, slots=True)
class FaultCourse:
    """Development of a fault of one phase over time.

    The points are (time [s] since the simulator's start, mu), joined by lines.
    """

    phase: int
    course: tuple[tuple[float, float], ...]
    resistance_ohm: float = 0.0

    def at(self, time_s: float) -> TurnFault:
        """Return the fault at one moment; before the first and after the last point it stays constant."""
        return TurnFault(self._level(time_s), self.phase, self.resistance_ohm)

    def _level(self, time_s: float) -> float:
        for (begin_s, begin), (end_s, end) in pairwise(self.course):
            if begin_s <= time_s < end_s:
                return begin + (end - begin) * (time_s - begin_s) / (end_s - begin_s)
        return self.course[0][1] if time_s < self.course[0][0] else self.course[-1][1]
