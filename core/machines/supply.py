"""The measured voltages as the models' input, on a fine enough time base.

A step takes the voltage as a straight line between samples, which loses (w h)^2 / 12 of a sine's amplitude.
Adding a twelfth of the second difference gives it back, so that the error left is of fourth order.
"""

from dataclasses import dataclass
from math import ceil, pi

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array
from core.signals.spline import refine

COARSEST_STEP_CYCLES = 1 / 80
"""Longest step in cycles of the supply; records sampled more slowly are stepped several times a sample."""


@dataclass(frozen=True, slots=True)
class Supply:
    """Stator voltage on the model's time base.

    voltage: v_s on the Clarke axes, shape (columns, 2), pre-emphasised [V].
    step_s: time between columns; `substeps` of them make one sample of the record.
    angular_frequency: w_s of the fundamental [rad/s]; phasor: its peak phasors on both axes at column 0 [V].
    """

    voltage: Array
    step_s: float
    substeps: int
    angular_frequency: float
    phasor: NDArray[np.complex128]


def supply(
    voltage_ab: Array, sample_rate_hz: float, frequency_hz: float, phasor: NDArray[np.complex128]
) -> Supply:
    """Supply from measured Clarke voltages (2, n) [V] and their peak phasors (2,) at sample 0."""
    substeps = ceil(frequency_hz / (sample_rate_hz * COARSEST_STEP_CYCLES))
    if substeps > 1:
        voltage_ab = refine(voltage_ab, substeps)
    emphasised = voltage_ab.copy()
    emphasised[:, 1:-1] -= (voltage_ab[:, 2:] - 2.0 * voltage_ab[:, 1:-1] + voltage_ab[:, :-2]) / 12.0
    return Supply(
        voltage=np.ascontiguousarray(emphasised.T),
        step_s=1.0 / (sample_rate_hz * substeps),
        substeps=substeps,
        angular_frequency=2.0 * pi * frequency_hz,
        phasor=phasor,
    )
