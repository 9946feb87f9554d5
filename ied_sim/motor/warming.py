"""Warming of the windings: their resistances as a function of time alone."""

from collections.abc import Callable
from dataclasses import dataclass
from math import exp, pi, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from core.units import SECONDS_PER_DAY

Array = NDArray[np.float64]

COPPER_PER_K = 0.00393
"""Temperature coefficient of the resistance of copper at 20 degrees [1/K] (IEC 60028)."""
ALUMINIUM_PER_K = 0.00403
"""Temperature coefficient of the resistance of aluminium at 20 degrees [1/K] (IEC 60889)."""

_MOMENTS = 256
"""Moments of the past that the heating is taken at; each counts alike."""


class ResistanceFactors(NamedTuple):
    """Resistances of stator and rotor over those of the parameters."""

    stator: float = 1.0
    rotor: float = 1.0


COLD = ResistanceFactors()
"""Those of windings at the temperature of the parameters."""


@dataclass(frozen=True, slots=True)
class Warming:
    """Temperatures of the windings above that of the motor's parameters, which they have before `begin_s`.

    Parameters
    ----------
    rise_K : float
        Rise above the ambient that a motor approaches at rated load.
    time_constant_s : float
        Time constant of the rise.
    begin_s : float
        Time since which the motor heats.
    idle_share : float
        Losses at no load over those at rated load; the rest goes with the square of the load.
    ambient_K, ambient_swing_K : float
        Ambient temperature above that of the parameters, and how far it swings about that in a day.
    rotor_per_K : float
        Temperature coefficient of the cage; the stator is of copper.
    """

    rise_K: float
    time_constant_s: float = 1800.0
    begin_s: float = 0.0
    idle_share: float = 0.35
    ambient_K: float = 0.0
    ambient_swing_K: float = 0.0
    rotor_per_K: float = ALUMINIUM_PER_K

    def temperature_K(self, time_s: float, load_level: Callable[[Array], Array]) -> float:
        """Return the temperature above that of the parameters.

        `load_level` gives the load at times [s], and NaN where the motor stands.
        """
        ambient_K = self.ambient_K + self.ambient_swing_K * sin(2 * pi * time_s / SECONDS_PER_DAY)
        lasted_s = time_s - self.begin_s
        if lasted_s <= 0 or self.rise_K == 0:
            return ambient_K
        # The mean of the losses, weighted with exp(-age / tau), is taken over the weight in place of the age.
        oldest = exp(-lasted_s / self.time_constant_s)
        weight = oldest + (1 - oldest) * (np.arange(_MOMENTS) + 0.5) / _MOMENTS
        levels = load_level(time_s + self.time_constant_s * np.log(weight))
        losses = self.idle_share + (1 - self.idle_share) * levels**2
        return ambient_K + self.rise_K * (1 - oldest) * float(np.mean(np.nan_to_num(losses)))

    def factors(self, time_s: float, load_level: Callable[[Array], Array]) -> ResistanceFactors:
        """Return the resistances at one moment over those of the parameters."""
        temperature_K = self.temperature_K(time_s, load_level)
        return ResistanceFactors(1 + COPPER_PER_K * temperature_K, 1 + self.rotor_per_K * temperature_K)
