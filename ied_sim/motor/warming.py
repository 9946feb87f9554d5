"""Windings that warm up: resistance as a function of time alone."""

from dataclasses import dataclass
from math import exp

COPPER_PER_K = 0.00393
"""Temperature coefficient of the resistance of copper at 20 degrees [1/K] (IEC 60028)."""


@dataclass(frozen=True, slots=True)
class Warming:
    """Windings rise by `rise_K` above the temperature the motor's parameters are of, with one time constant.

    begin_s: since when, in seconds since the simulator's start; they are cold before.
    """

    rise_K: float
    time_constant_s: float = 1800.0
    begin_s: float = 0.0

    def resistance_factor(self, time_s: float) -> float:
        """Stator and rotor resistance over that of the parameters."""
        warm = 1 - exp(-max(0.0, time_s - self.begin_s) / self.time_constant_s)
        return 1 + COPPER_PER_K * self.rise_K * warm
