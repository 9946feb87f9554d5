"""Channels that a recorder samples one after another, brought to one instant."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

POINTS = 6
"""Samples a value is interpolated from. At 16 samples a cycle the fundamental's error is below 1e-4."""

_UNEVEN = 1.25
"""A step longer than its neighbour by this factor ends a stretch: less is the rounding of time stamps."""


def without_skew(x: NDArray[np.float64], skew: float) -> NDArray[np.float64]:
    """Interpolate a waveform sampled at n + skew at the instants n.

    Lagrange interpolation goes through the nearest samples, those at the ends from one side. A missing sample
    (NaN) makes its neighbours missing, too.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Samples.
    skew : float
        Delay in sample periods, magnitude below 1.

    Returns
    -------
    ndarray, shape (n,)
        Values in the unit of x.
    """
    points = min(POINTS, x.size)
    before = (points - 1) // 2
    last = x.size - points
    y = np.empty(x.size)
    y[before : before + last + 1] = np.correlate(x, _weights(points, before - skew), "valid")
    for n in (*range(before), *range(before + last + 1, x.size)):
        first = min(max(n - before, 0), last)
        y[n] = _weights(points, n - skew - first) @ x[first : first + points]
    return y


def even_stretches(instants_s: NDArray[np.float64]) -> Iterator[tuple[slice, float]]:
    """Find stretches of evenly spaced samples, in order; single samples are left out.

    Parameters
    ----------
    instants_s : ndarray, shape (n,)
        Increasing times of the samples [s].

    Yields
    ------
    (slice, float)
        The stretch, and the period of its samples [s].
    """
    steps = np.diff(instants_s)
    around = np.concatenate([[np.inf], steps, [np.inf]])
    breaks = np.flatnonzero(steps > _UNEVEN * np.minimum(around[:-2], around[2:])) + 1
    for first, last in zip([0, *breaks], [*breaks, instants_s.size], strict=True):
        if last - first > 1:
            yield slice(first, last), float((instants_s[last - 1] - instants_s[first]) / (last - first - 1))


def _weights(points: int, position: float) -> NDArray[np.float64]:
    """Weights of the samples at 0, 1, ... points - 1 for the value at `position`."""
    j = np.arange(points)
    weights = np.ones(points)
    for k in range(points):
        others = j != k
        weights[others] *= (position - k) / (j[others] - k)
    return weights
