"""Single samples that are none: what converters and links put into a waveform that repeats."""

import numpy as np

from core.machines.base import Array

SPIKE = 6.0
"""Robust standard deviations from which on a sample is a spike."""
STEPS = 0.5
"""Least noise of a sample, in steps of its converter: cycles whose samples are equal tell none."""
LOOKED_AT = 2_000
"""Samples that tell the converter's step."""
NORMAL_OVER_MEDIAN = 1.4826
"""Standard deviation of normal noise over the median of its magnitude."""


def without_spikes(x: Array, per_cycle: float) -> tuple[Array, int]:
    """Replace samples that differ from those of the cycles before and after them.

    A sample is compared with the median of itself and its neighbours of one cycle earlier and later, which a
    spike in one of them does not move; in the first and the last cycle, with the two nearest there are. What
    cycles differ by tells the noise, at least half a step of the converter.

    Parameters
    ----------
    x : ndarray, shape (m, n)
        Samples, finite, three cycles of them and more.
    per_cycle : float
        Samples in a cycle of the supply.

    Returns
    -------
    samples : ndarray, shape (m, n)
        The samples, spikes replaced by the median.
    spikes : int
        Number of samples replaced.
    """
    cycle = round(per_cycle)
    before = np.concatenate([x[:, 2 * cycle : 3 * cycle], x[:, :-cycle]], axis=1)
    after = np.concatenate([x[:, cycle:], x[:, -3 * cycle : -2 * cycle]], axis=1)
    middle = np.maximum(np.minimum(before, x), np.minimum(np.maximum(before, x), after))
    noise = NORMAL_OVER_MEDIAN / np.sqrt(2.0) * np.median(np.abs(x - before), axis=1, keepdims=True)
    is_spike = np.abs(x - middle) > SPIKE * np.maximum(noise, STEPS * _steps(x))
    if not is_spike.any():
        return x, 0
    return np.where(is_spike, middle, x), int(is_spike.sum())


def _steps(x: Array) -> Array:
    """Return the usual distance between neighbouring values, shape (m, 1): the step of a coarse converter."""
    values = [np.unique(row[:LOOKED_AT]) for row in x]
    return np.array([[np.median(np.diff(one)) if one.size > 1 else 0.0] for one in values])
