"""Transformers and converters between the motor and the samples, with their errors."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

CHANNELS = ("IA", "IB", "IC", "VA", "VB", "VC")
CODE_LIMIT = 32767
"""Largest code of the 16-bit converters. The code -32768 marks missing samples in COMTRADE."""


@dataclass(frozen=True, slots=True)
class Sensors:
    """Errors of the six channels, IA IB IC VA VB VC.

    Parameters
    ----------
    full_scale_A, full_scale_V : float
        Range of the converters, peak. They clip beyond it.
    gain_errors : tuple of float
        Relative gain error of each channel.
    offsets : tuple of float
        Offset of each channel as a fraction of the rated value (rms).
    current_delay_s : float
        Delay of the current channels after the voltage channels [s].
    noise : float
        Standard deviation of the white noise as a fraction of the rated value (rms).
    """

    full_scale_A: float
    full_scale_V: float
    gain_errors: tuple[float, ...] = (0.0,) * 6
    offsets: tuple[float, ...] = (0.0,) * 6
    current_delay_s: float = 0.0
    noise: float = 0.0

    def measure(self, true: Array, rated: Array, random: np.random.Generator) -> Array:
        """Return quantised samples of true currents [A] and voltages [V], shape (6, n).

        `rated` holds the channels' rated values, rms, shape (6,).
        """
        seen = true * (1 + np.array(self.gain_errors))[:, None]
        seen += (rated * np.array(self.offsets))[:, None]
        if self.noise:
            seen += (rated * self.noise)[:, None] * random.standard_normal(true.shape)
        step = np.repeat([self.full_scale_A, self.full_scale_V], 3)[:, None] / CODE_LIMIT
        samples: Array = np.clip(np.rint(seen / step), -CODE_LIMIT, CODE_LIMIT) * step
        return samples
