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

    Parameters
    ----------
    voltage : ndarray, shape (columns, 2)
        Clarke voltages, pre-emphasised [V].
    step_s : float
        Time between columns [s].
    substeps : int
        Columns in one sample of the record.
    angular_frequency : float
        Angular frequency w_s of the fundamental [rad/s].
    phasor : ndarray of complex, shape (2,)
        Peak phasors of the fundamental on both axes at column 0 [V].
    """

    voltage: Array
    step_s: float
    substeps: int
    angular_frequency: float
    phasor: NDArray[np.complex128]


def supply(
    voltage_ab: Array, sample_rate_hz: float, frequency_hz: float, phasor: NDArray[np.complex128]
) -> Supply:
    """Make the models' supply from measured voltages.

    Parameters
    ----------
    voltage_ab : ndarray, shape (2, n)
        Voltages on power-invariant Clarke axes [V].
    sample_rate_hz : float
        Sampling rate [Hz].
    frequency_hz : float
        Supply frequency [Hz].
    phasor : ndarray of complex, shape (2,)
        Peak phasors of the fundamental on both axes at sample 0 [V].

    Returns
    -------
    Supply
        The supply.
    """
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
