"""Transformers and converters between the motor and the samples, with their errors."""

from dataclasses import dataclass
from math import inf

import numpy as np
from numpy.typing import NDArray

from core.units import SECONDS_PER_DAY

Array = NDArray[np.float64]

CHANNELS = ("IA", "IB", "IC", "VA", "VB", "VC")
CODE_LIMIT = 32767
"""Largest code of the 16-bit converters. The code -32768 marks missing samples in COMTRADE."""


@dataclass(frozen=True, slots=True)
class ChannelChange:
    """A channel that changes at `at_s` [s]: its gain error and its delay jump, and drift from then on.

    `channel` is 0 to 5, in the order of CHANNELS. The drift ends at `until_s`, and what it has made stays.
    """

    channel: int
    at_s: float
    gain: float = 0.0
    delay_s: float = 0.0
    gain_per_day: float = 0.0
    delay_per_day_s: float = 0.0
    until_s: float = inf

    def at(self, time_s: float) -> tuple[float, float]:
        """Return what it adds to the channel's gain error and to its delay [s] at one moment."""
        if time_s < self.at_s:
            return 0.0, 0.0
        days = (min(time_s, self.until_s) - self.at_s) / SECONDS_PER_DAY
        return self.gain + self.gain_per_day * days, self.delay_s + self.delay_per_day_s * days


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
    delays_s : tuple of float
        Delay of each channel, beside `current_delay_s` [s].
    changes : tuple of ChannelChange
        How single channels change over time.
    """

    full_scale_A: float
    full_scale_V: float
    gain_errors: tuple[float, ...] = (0.0,) * 6
    offsets: tuple[float, ...] = (0.0,) * 6
    current_delay_s: float = 0.0
    noise: float = 0.0
    delays_s: tuple[float, ...] = (0.0,) * 6
    changes: tuple[ChannelChange, ...] = ()

    def gains(self, time_s: float) -> Array:
        """Return the relative gain errors at one moment, shape (6,)."""
        return np.array(self.gain_errors) + self.changed(time_s)[:, 0]

    def delays(self, time_s: float) -> Array:
        """Return the delays at one moment [s], shape (6,)."""
        common = np.repeat([self.current_delay_s, 0.0], 3)
        delays: Array = np.array(self.delays_s) + common + self.changed(time_s)[:, 1]
        return delays

    def changed(self, time_s: float) -> Array:
        """Return by how much gain error and delay [s] of each channel have changed by now, shape (6, 2)."""
        changed = np.zeros((6, 2))
        for change in self.changes:
            changed[change.channel] += change.at(time_s)
        return changed

    def measure(self, true: Array, rated: Array, random: np.random.Generator, time_s: float = 0.0) -> Array:
        """Return quantised samples of true currents [A] and voltages [V], shape (6, n).

        `rated` holds the channels' rated values, rms, shape (6,). The gains are those of `time_s`; the delays
        are in the true values already.
        """
        seen = true * (1 + self.gains(time_s))[:, None]
        seen += (rated * np.array(self.offsets))[:, None]
        if self.noise:
            seen += (rated * self.noise)[:, None] * random.standard_normal(true.shape)
        step = np.repeat([self.full_scale_A, self.full_scale_V], 3)[:, None] / CODE_LIMIT
        samples: Array = np.clip(np.rint(seen / step), -CODE_LIMIT, CODE_LIMIT) * step
        return samples
