"""The busbar: three phase voltages as a function of time alone, so that any two windows of it agree."""

from dataclasses import dataclass
from math import pi, sqrt
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Harmonic:
    """One harmonic voltage: its order, its share of the fundamental and its angle to it.

    It has the sequence its order has by nature: the 5th negative, the 7th positive. Orders divisible by three
    have none and drive no current into three wires.
    """

    order: int
    fraction: float
    angle_rad: float = 0.0


@dataclass(frozen=True, slots=True)
class Supply:
    """Voltages of a three-phase busbar.

    line_voltage_V: positive-sequence line-to-line voltage, rms.
    frequency_drift_Hz, drift_period_s: the frequency swings by so much about its mean, once a period.
    unbalance, unbalance_angle_rad: voltage unbalance factor |V2| / |V1| and the angle of V2 to V1.
    sequence: which way the phases follow each other; with acb motors turn backwards.
    """

    line_voltage_V: float
    frequency_Hz: float
    frequency_drift_Hz: float = 0.0
    drift_period_s: float = 300.0
    unbalance: float = 0.0
    unbalance_angle_rad: float = 0.0
    harmonics: tuple[Harmonic, ...] = ()
    sequence: Literal["abc", "acb"] = "abc"

    @property
    def direction(self) -> int:
        """+1 where the field turns from a to b to c, -1 where it turns the other way."""
        return 1 if self.sequence == "abc" else -1

    def frequency(self, time_s: float) -> float:
        """Frequency at one moment [Hz]."""
        return self.frequency_Hz + self.frequency_drift_Hz * float(
            np.sin(2 * pi * time_s / self.drift_period_s)
        )

    def phase_voltages(self, time_s: Array) -> Array:
        """Voltages of a, b, c against the neutral [V], shape (3, n), at the times [s], shape (n,)."""
        swing = self.frequency_drift_Hz * self.drift_period_s / (2 * pi)
        turns = self.frequency_Hz * time_s - swing * np.cos(2 * pi * time_s / self.drift_period_s)
        angle = 2 * pi * turns
        behind = self.direction * np.array([[0.0], [2 * pi / 3], [4 * pi / 3]])
        voltages: Array = np.cos(angle - behind)
        if self.unbalance:
            voltages += self.unbalance * np.cos(angle + self.unbalance_angle_rad + behind)
        for harmonic in self.harmonics:
            h = harmonic.order
            voltages += harmonic.fraction * np.cos(h * (angle - behind) + harmonic.angle_rad)
        voltages *= sqrt(2 / 3) * self.line_voltage_V
        return voltages
