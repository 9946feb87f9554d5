"""Single samples that are none: what converters and links put into a waveform that repeats."""

import numpy as np

from core.machines.base import Array

SPIKE = 6.0
"""Robust standard deviations from which on a sample is a spike."""
NORMAL_OVER_MEDIAN = 1.4826
"""Standard deviation of normal noise over the median of its magnitude."""


def without_spikes(x: Array, per_cycle: float) -> tuple[Array, int]:
    """Replace samples that differ from those of the cycles before and after them.

    A sample is compared with the median of itself and its neighbours of one cycle earlier and later, which a
    spike in one of them does not move. What cycles differ by tells the noise.

    Parameters
    ----------
    x : ndarray, shape (m, n)
        Samples, finite, more than two cycles of them.
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
    before, now, after = x[:, : -2 * cycle], x[:, cycle:-cycle], x[:, 2 * cycle :]
    middle = np.maximum(np.minimum(before, now), np.minimum(np.maximum(before, now), after))
    noise = NORMAL_OVER_MEDIAN / np.sqrt(2.0) * np.median(np.abs(now - before), axis=1, keepdims=True)
    is_spike = np.abs(now - middle) > SPIKE * noise
    if not is_spike.any():
        return x, 0
    cleaned = x.copy()
    cleaned[:, cycle:-cycle][is_spike] = middle[is_spike]
    return cleaned, int(is_spike.sum())
