"""Currents of a motor with slot and eccentricity lines: their own arithmetic, not that of the method."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SLOT_LINES = {(-3, 1): 2.9e-3, (1, 1): 2.7e-3, (5, -1): 1.0e-3, (3, 1): 0.8e-3}
"""Amplitude of the space vector [share of the fundamental] by h and the sign of R."""
ECCENTRIC_LINES = {(-3, 1): 1.5e-3, (1, -1): 4e-3, (1, 1): 3e-3, (5, -1): 0.8e-3, (-1, -1): 1e-3}
TURNING_LINES = {(1, 1): 1.2e-3, (-3, 1): 0.6e-3}
"""The slots' lines moved by a turn."""
HARMONICS = {1: 1.0, -1: 0.03, 5: 0.004, -5: 0.02, 7: 0.015, -7: 0.002, 11: 0.001, -11: 0.006, 13: 0.004}


@dataclass(frozen=True)
class MotorCurrents:
    """A cage motor that runs; what is drawn by chance depends on the seed alone."""

    bars: int = 28
    pole_pairs: int = 2
    frequency_hz: float = 50.0
    slip: float = 0.02
    slip_change: float = 0.0
    """Change of the slip through the record."""
    lines: float = 1.0
    """Amplitude of the rotor's lines, over that of the tables above."""
    noise: float = 0.002
    """Rms of each channel's white noise, over the current's rms."""
    foreign_hz: dict[float, float] = field(default_factory=lambda: {34.0: 0.02, 66.0: 0.02})
    """Lines of a belt: amplitude by frequency."""
    backward: bool = False
    seed: int = 0

    @property
    def speed_rpm(self) -> float:
        return 60.0 * self.frequency_hz * (1.0 - self.slip - self.slip_change / 2.0) / self.pole_pairs

    def abc(self, duration_s: float, rate_hz: float) -> Array:
        """Return the currents of a, b, c, shape (3, n) [A]."""
        random = np.random.default_rng(self.seed)
        t = np.arange(round(duration_s * rate_hz)) / rate_hz
        supply = 2.0 * np.pi * self.frequency_hz * t
        slipped = self.slip * t + 0.5 * self.slip_change * t**2 / duration_s
        shaft = 2.0 * np.pi * self.frequency_hz * (t - slipped) / self.pole_pairs
        z = np.zeros(t.size, complex)
        for order, size in HARMONICS.items():
            z += size * np.exp(1j * (order * supply + random.uniform(0.0, 6.28)))
        for turns, table in ((self.bars, SLOT_LINES), (1, ECCENTRIC_LINES)):
            for (h, sign), size in table.items():
                angle = h * supply + sign * turns * shaft
                z += self.lines * size * np.exp(1j * (angle + random.uniform(0.0, 6.28)))
        for (h, sign), size in TURNING_LINES.items():
            angle = h * supply + sign * (self.bars + 1) * shaft
            z += self.lines * size * np.exp(1j * (angle + random.uniform(0.0, 6.28)))
        for hertz, size in self.foreign_hz.items():
            z += size * np.exp(2j * np.pi * (hertz * t + random.uniform()))
        z *= 10.0
        if self.backward:
            z = z.conj()
        turn = np.exp(2j * np.pi / 3.0 * np.arange(3))
        clean = np.real(z * turn[:, np.newaxis].conj())
        return np.asarray(clean + 10.0 / 2.0**0.5 * self.noise * random.standard_normal(clean.shape))
