"""Kalman filters of a level and its growth, one a trend (see `core.condition.forecast.forecast`)."""

from math import exp, log, pi

import numpy as np
from numpy.typing import NDArray

from core.machines.compiled import compiled_as_written as compiled

Array = NDArray[np.float64]

LEVEL_DEVIATION = 0.05
"""Prior standard deviation of the first level."""

GROWTH_DEVIATION = 0.001
"""Prior standard deviation of the first growth, a record."""

MOST_BEFORE = 12
"""Records before the onset that are looked for among the first: it is known no better than that."""

MOST_GROWTH = 40.0
"""Largest lambda h: beyond it every level is reached."""


@compiled
def spread(h: float, rate: float) -> tuple[float, float, float, float, float]:
    """Return how a trend moves over h records.

    Parameters
    ----------
    h : float
        Time [records].
    rate : float
        lambda [1/record].

    Returns
    -------
    tuple of float
        Share of the growth in the level, factor of the growth, and of the density of its noise: variance of
        the level, covariance, variance of the growth.
    """
    x = min(rate * h, MOST_GROWTH)
    if x < 1e-3:
        # Series in x; the closed forms below cancel.
        return (
            h * (1.0 + x / 2.0),
            1.0 + x + x * x / 2.0,
            h**3 / 3.0 * (1.0 + 0.75 * x),
            h * h / 2.0 * (1.0 + x),
            h * (1.0 + x),
        )
    once, twice = exp(x) - 1.0, (exp(2.0 * x) - 1.0) / 2.0
    return (
        once / rate,
        1.0 + once,
        (twice - 2.0 * once + x) / rate**3,
        (twice - once) / rate**2,
        twice / rate,
    )


@compiled
def filtered(
    t: Array, m: Array, variance: float, rates: Array, densities: Array
) -> tuple[Array, Array, Array]:
    """Filter levels by every trend.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Times [records].
    m : ndarray, shape (n,)
        Levels.
    variance : float
        Variance of a single level.
    rates, densities : ndarray, shape (k,)
        lambda and q of the trends.

    Returns
    -------
    state : ndarray, shape (k, 2)
        Level and growth at the last time.
    covariance : ndarray, shape (k, 2, 2)
        Their covariance.
    ln_likelihood : ndarray, shape (k,)
        Log of each trend's likelihood.
    """
    trends = rates.size
    state = np.zeros((trends, 2))
    covariance = np.zeros((trends, 2, 2))
    ln_likelihood = np.zeros(trends)
    for i in range(trends):
        level, growth, total = 0.0, 0.0, 0.0
        p00, p01, p11 = LEVEL_DEVIATION**2, 0.0, GROWTH_DEVIATION**2
        h, (share, factor, q00, q01, q11) = 0.0, spread(0.0, rates[i])
        for k in range(t.size):
            if k > 0:
                if t[k] - t[k - 1] != h:  # most records are equally far apart
                    h = t[k] - t[k - 1]
                    share, factor, q00, q01, q11 = spread(h, rates[i])
                level, growth = level + share * growth, factor * growth
                p00 += 2.0 * share * p01 + share * share * p11 + densities[i] * q00
                p01 = factor * (p01 + share * p11) + densities[i] * q01
                p11 = factor * factor * p11 + densities[i] * q11
            innovation, s = m[k] - level, p00 + variance
            total -= 0.5 * (log(2.0 * pi * s) + innovation * innovation / s)
            level, growth = level + p00 / s * innovation, growth + p01 / s * innovation
            p00, p01, p11 = p00 * variance / s, p01 * variance / s, p11 - p01 * p01 / s
        state[i, 0], state[i, 1] = level, growth
        covariance[i, 0, 0], covariance[i, 1, 1] = p00, p11
        covariance[i, 0, 1] = covariance[i, 1, 0] = p01
        ln_likelihood[i] = total
    return state, covariance, ln_likelihood


@compiled
def onset(t: Array, m: Array, variance: float, densities: Array) -> int:
    """Tell which of the first levels are from before the change.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Times [records].
    m : ndarray, shape (n,)
        Changes of the level, which are zero before the change but for their scatter.
    variance : float
        Variance of a single level.
    densities : ndarray, shape (k,)
        q of trends whose growth does not feed itself.

    Returns
    -------
    int
        Number of levels from before the change, likeliest; at most a third of all.
    """
    still, best, highest = 0.0, 0, -np.inf
    for first in range(min(MOST_BEFORE, t.size // 3) + 1):
        if first > 0:
            still -= 0.5 * (log(2.0 * pi * variance) + m[first - 1] * m[first - 1] / variance)
        _, _, ln_likelihood = filtered(t[first:], m[first:], variance, 0.0 * densities, densities)
        total = still + np.max(ln_likelihood)
        if total > highest:
            best, highest = first, total
    return best


@compiled
def moved(
    ahead: Array, state: Array, covariance: Array, rates: Array, densities: Array
) -> tuple[Array, Array]:
    """Move every trend ahead.

    Parameters
    ----------
    ahead : ndarray, shape (n,)
        Times from the last level on [records].
    state : ndarray, shape (k, 2)
        Level and growth at the last time.
    covariance : ndarray, shape (k, 2, 2)
        Their covariance.
    rates, densities : ndarray, shape (k,)
        lambda and q of the trends.

    Returns
    -------
    mean, variance : ndarray, shape (k, n)
        Of the level.
    """
    mean = np.empty((rates.size, ahead.size))
    variance = np.empty((rates.size, ahead.size))
    for i in range(rates.size):
        for k in range(ahead.size):
            share, _, q00, _, _ = spread(ahead[k], rates[i])
            mean[i, k] = state[i, 0] + share * state[i, 1]
            variance[i, k] = (
                covariance[i, 0, 0]
                + 2.0 * share * covariance[i, 0, 1]
                + share * share * covariance[i, 1, 1]
                + densities[i] * q00
            )
    return mean, variance
