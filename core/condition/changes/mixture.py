"""95 % interval of a mixture of normal distributions: of a level that several causes may explain."""

from math import erfc, sqrt
from typing import Final

import numpy as np

from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled

TAIL: Final = 0.025
GRID: Final = 400


@compiled
def interval_of(shares: Array, means: Array, deviations: Array) -> tuple[float, float]:
    """Return the 95 % interval of a mixture of normal distributions.

    Parameters
    ----------
    shares, means, deviations : ndarray, shape (n,)
        Weight, mean and standard deviation of each of them.

    Returns
    -------
    tuple of float
        Lower and upper end.
    """
    low, high = np.min(means - 5.0 * deviations), np.max(means + 5.0 * deviations)
    return (
        _quantile(TAIL, low, high, shares, means, deviations),
        _quantile(1.0 - TAIL, low, high, shares, means, deviations),
    )


@compiled
def _quantile(share: float, low: float, high: float, shares: Array, means: Array, deviations: Array) -> float:
    """Return the value below which a share of the mixture lies, linear between the points of a grid."""
    step = (high - low) / (GRID - 1)
    first, last = 0, GRID - 1
    before, after = _below(low, shares, means, deviations), _below(high, shares, means, deviations)
    if share <= before:
        return low
    if share >= after:
        return high
    while last - first > 1:
        middle = (first + last) // 2
        below = _below(low + middle * step, shares, means, deviations)
        if below <= share:
            first, before = middle, below
        else:
            last, after = middle, below
    return low + step * (first + (share - before) / (after - before))


@compiled
def _below(value: float, shares: Array, means: Array, deviations: Array) -> float:
    """Return the share of the mixture below a value."""
    found = 0.0
    for n in range(shares.size):
        found += shares[n] * 0.5 * erfc((means[n] - value) / (deviations[n] * sqrt(2.0)))
    return found
