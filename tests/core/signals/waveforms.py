"""Three-phase waveforms written straight from their definition, as reference for the estimators."""

from collections.abc import Mapping
from math import pi

import numpy as np
from numpy.typing import NDArray


def three_phase(
    positive: complex,
    negative: complex = 0,
    *,
    frequency_hz: float = 50.0,
    sample_rate_hz: float = 10_000.0,
    samples: int = 5_000,
    harmonics: Mapping[int, complex] | None = None,
) -> NDArray[np.float64]:
    """x_a, x_b, x_c, shape (3, samples), of rms phasors; harmonics: signed order -> rms phasor of phase a.

    A negative order is a harmonic of negative sequence: -5 is the usual 5th.
    """
    t = np.arange(samples) / sample_rate_hz
    parts = {1: positive, -1: negative, **(harmonics or {})}
    rows = []
    for phase in range(3):
        x = np.zeros(samples)
        for order, phasor in parts.items():
            sign = 1 if order > 0 else -1
            lag = sign * 2 * pi / 3 * phase
            angle = 2 * pi * frequency_hz * abs(order) * t + np.angle(phasor) - lag
            x += np.sqrt(2) * abs(phasor) * np.cos(angle)
        rows.append(x)
    return np.array(rows)
