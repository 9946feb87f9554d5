"""Shorted stator turns: their state at one moment, and how they develop."""

from dataclasses import dataclass

from ied_sim.motor.course import Points, value_at

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

    The points are (time [s], mu), joined by lines. The path has `resistance_ohm` and, for each share mu of
    the turns, mu times `turns_resistance_ohm`: a path of ratio p has p R_s there, and the equivalent level is
    mu / (1 + p) however far the fault has grown.
    """

    phase: int
    course: Points
    resistance_ohm: float = 0.0
    turns_resistance_ohm: float = 0.0

    def at(self, time_s: float) -> TurnFault:
        """Return the fault at one moment; before the first and after the last point it stays constant."""
        turns = value_at(self.course, time_s)
        return TurnFault(turns, self.phase, self.resistance_ohm + turns * self.turns_resistance_ohm)
