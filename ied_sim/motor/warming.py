"""Warming of the windings: resistance as a function of time alone."""

from dataclasses import dataclass
from math import exp

COPPER_PER_K = 0.00393
"""Temperature coefficient of the resistance of copper at 20 degrees [1/K] (IEC 60028)."""


@dataclass(frozen=True, slots=True)
class Warming:
    """Rise of the windings by `rise_K` above the temperature of the motor's parameters.

    It begins at `begin_s`, in seconds since the simulator's start, with one time constant; the windings are
    cold before.
    """

    rise_K: float
    time_constant_s: float = 1800.0
    begin_s: float = 0.0

    def resistance_factor(self, time_s: float) -> float:
        """Return stator and rotor resistance over that of the parameters."""
        warm = 1 - exp(-max(0.0, time_s - self.begin_s) / self.time_constant_s)
        return 1 + COPPER_PER_K * self.rise_K * warm
