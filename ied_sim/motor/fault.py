"""Shorted stator turns: their state at one moment, and how they develop."""

from dataclasses import dataclass

from ied_sim.motor.course import Points, value_at

NEGLIGIBLE_LEVEL = 1e-5
"""Equivalent level below which a fault draws less than the noise and would only stiffen the equations."""
NEGLIGIBLE_LEVEL_IN_COIL = 1e-4
"""The same of turns inside one coil, whose loop decays at about R_s / (N L_ls mu_eq)."""


@dataclass(frozen=True, slots=True)
class TurnFault:
    """A path of `resistance_ohm` across the fraction `turns` (mu) of the turns of phase 0, 1 or 2 (a, b, c).

    In a delta motor phase a is the winding between terminals a and b. With `coil` the turns are those of one
    coil of a winding by slots: of coil 1 to N of the phase, in the order of its groups. `turns` counts all
    coils of the phase; with parallel `branches` its turns have the resistance mu branches^2 R_s.
    """

    turns: float
    phase: int
    resistance_ohm: float = 0.0
    coil: int | None = None
    branches: int = 1

    def equivalent_level(self, stator_resistance_ohm: float) -> float:
        """Return the level mu_eq of the bolted short that draws the same current, leakage aside.

        mu_eq = R_s / (r_f / mu^2 + R_s / mu) without branches.
        """
        if self.turns == 0:
            return 0.0
        of_turns = self.turns * self.branches**2 * stator_resistance_ohm
        return self.turns / (1 + self.resistance_ohm / of_turns)

    @property
    def negligible_level(self) -> float:
        """Equivalent level below which the motor is as good as healthy."""
        return NEGLIGIBLE_LEVEL if self.coil is None else NEGLIGIBLE_LEVEL_IN_COIL


@dataclass(frozen=True, slots=True)
class FaultCourse:
    """Development of a fault of one phase over time.

    The points are (time [s], mu), joined by lines. The path has `resistance_ohm` and, for each share mu of
    the turns, mu times `turns_resistance_ohm`: a path of ratio p has p R_s there, and the equivalent level is
    mu / (1 + p) however far the fault has grown. With `branches` that is p R_s branches^2. `coil` is as in
    `TurnFault`.
    """

    phase: int
    course: Points
    resistance_ohm: float = 0.0
    turns_resistance_ohm: float = 0.0
    coil: int | None = None
    branches: int = 1

    def at(self, time_s: float) -> TurnFault:
        """Return the fault at one moment; before the first and after the last point it stays constant."""
        turns = value_at(self.course, time_s)
        path_ohm = self.resistance_ohm + turns * self.turns_resistance_ohm
        return TurnFault(turns, self.phase, path_ohm, self.coil, self.branches)
