"""Recordings of supplies whose figures are known because they are made of them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray

from core.recordings import Channel, Quantity, Recording

Array = NDArray[np.float64]

NAMES = ("IA", "IB", "IC", "VA", "VB", "VC")


@dataclass(frozen=True, slots=True)
class Sines:
    """Three phases: amplitude of the positive sequence, shares of it in the negative one and in harmonics.

    interharmonics: share by frequency [Hz]. lag: of the positive sequence [rad].
    """

    amplitude: float
    negative: float = 0.0
    harmonics: Mapping[int, float] = field(default_factory=dict)
    interharmonics: Mapping[float, float] = field(default_factory=dict)
    lag: float = 0.0

    def at(self, time_s: Array, angle: Array, order: float) -> Array:
        """The phases. angle: of the fundamental. order: 1 for a, b, c, -1 for a, c, b."""
        rows = []
        for phase in (0.0, -2.0 * pi / 3.0 * order, 2.0 * pi / 3.0 * order):
            row = np.cos(angle + phase - self.lag) + self.negative * np.cos(angle - phase + 0.4)
            for number, share in self.harmonics.items():
                row += share * np.cos(number * (angle + phase) + 0.7 * number)
            for frequency_hz, share in self.interharmonics.items():
                row += share * np.cos(2.0 * pi * frequency_hz * time_s + phase)
            rows.append(self.amplitude * row)
        return np.array(rows)


def recording(
    volts: Sines,
    amps: Sines,
    *,
    frequency_hz: float = 50.0,
    wander_hz: float = 0.0,
    duration_s: float = 2.0,
    sample_rate_hz: float = 10_000.0,
    noise: float = 0.0,
    order: float = 1.0,
) -> Recording:
    """Make a recording. wander_hz: half the swing of the frequency, once in 7 s. noise: of the amplitudes."""
    t = np.arange(round(duration_s * sample_rate_hz)) / sample_rate_hz
    angle = 2.0 * pi * frequency_hz * t - 7.0 * wander_hz * np.cos(2.0 * pi * t / 7.0) + 0.3
    samples = np.vstack([one.at(t, angle, order) for one in (amps, volts)])
    random = np.random.default_rng(3)
    sizes = np.repeat([amps.amplitude, volts.amplitude], 3)[:, np.newaxis]
    samples += noise * sizes * random.normal(size=samples.shape)
    quantities = (Quantity.CURRENT, Quantity.PHASE_VOLTAGE)
    channels = [
        Channel(name, quantities[number // 3], "abc"[number % 3], "AV"[number // 3])
        for number, name in enumerate(NAMES)
    ]
    return Recording(samples, sample_rate_hz, 0, tuple(channels))


def phase_amplitude(line_V: float) -> float:
    """Amplitude of a phase voltage."""
    return line_V * sqrt(2.0 / 3.0)
