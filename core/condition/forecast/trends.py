"""Kalman filters of a level and its growth, one a trend (see `core.condition.forecast.forecast`).

The filters of all trends run beside each other, record by record.
"""

from math import erfc, exp, log, sqrt

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

FEW = 8.0
"""So many records tell their own variance within about half; it is taken as larger where there are few."""

MEDIAN_OF_SQUARES = 0.4549
"""Median of the square of a standard normal variable."""

LEAST_VARIANCE = 1e-14
LEAST_TIME = 1e-9
TOGETHER = 8
"""Variances whose logarithm is taken together, which costs as much as that of one."""

NEGLIGIBLE = 1e-3
"""Trends of less probability are left out of the time to the limit."""

SURE = 0.9999
"""Probability from which on it is taken as one."""

FAR = 6.0
"""Standard deviations beyond which a probability is taken as zero or one."""


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
def scatter(t: Array, m: Array) -> float:
    """Return the variance of single levels, from how far each lies beside the line through its neighbours.

    It is that of the median, so that a step in the levels is not taken for scatter.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Times [records], at least three.
    m : ndarray, shape (n,)
        Levels.

    Returns
    -------
    float
        Variance.
    """
    squares = np.empty(t.size - 2)
    for k in range(1, t.size - 1):
        share = (t[k] - t[k - 1]) / max(t[k + 1] - t[k - 1], LEAST_TIME)
        beside = m[k] - (1.0 - share) * m[k - 1] - share * m[k + 1]
        squares[k - 1] = beside * beside / (1.0 + share * share + (1.0 - share) * (1.0 - share))
    return max(np.median(squares) / MEDIAN_OF_SQUARES * (1.0 + FEW / t.size), LEAST_VARIANCE)


@compiled
def filtered(
    t: Array, m: Array, variance: float, rates: Array, densities: Array, firsts: NDArray[np.int64]
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
    firsts : ndarray of int, shape (k,)
        First level that each trend takes, in rising order.

    Returns
    -------
    state : ndarray, shape (2, k)
        Level and growth at the last time.
    covariance : ndarray, shape (3, k)
        Variance of the level, covariance, variance of the growth.
    ln_likelihood : ndarray, shape (k,)
        Log of each trend's likelihood, without the factors sqrt(2 pi).
    """
    trends = rates.size
    level, growth = np.zeros(trends), np.zeros(trends)
    p00, p01, p11 = (
        np.full(trends, LEVEL_DEVIATION**2),
        np.zeros(trends),
        np.full(trends, GROWTH_DEVIATION**2),
    )
    share, factor = np.zeros(trends), np.zeros(trends)
    q00, q01, q11 = np.zeros(trends), np.zeros(trends), np.zeros(trends)
    squares, product, ln_likelihood = np.zeros(trends), np.ones(trends), np.zeros(trends)
    h = -1.0
    begun = 0
    for k in range(firsts[0], t.size):
        if k > 0 and begun > 0:
            if t[k] - t[k - 1] != h:  # most records are equally far apart
                h = t[k] - t[k - 1]
                for i in range(trends):
                    share[i], factor[i], q00[i], q01[i], q11[i] = spread(h, rates[i])
            for i in range(begun):
                a, f, q = share[i], factor[i], densities[i]
                level[i] += a * growth[i]
                growth[i] *= f
                p00[i] += 2.0 * a * p01[i] + a * a * p11[i] + q * q00[i]
                p01[i] = f * (p01[i] + a * p11[i]) + q * q01[i]
                p11[i] = f * f * p11[i] + q * q11[i]
        while begun < trends and firsts[begun] <= k:
            begun += 1
        for i in range(begun):
            innovation, s = m[k] - level[i], p00[i] + variance
            inverse = 1.0 / s
            gain, gain_growth = p00[i] * inverse, p01[i] * inverse
            level[i] += gain * innovation
            growth[i] += gain_growth * innovation
            p11[i] -= gain_growth * p01[i]
            p00[i] *= variance * inverse
            p01[i] *= variance * inverse
            squares[i] += innovation * innovation * inverse
            product[i] *= s
        if k % TOGETHER == 0 or k == t.size - 1:
            for i in range(begun):
                ln_likelihood[i] -= 0.5 * log(product[i])
                product[i] = 1.0
    state, covariance = np.empty((2, trends)), np.empty((3, trends))
    state[0], state[1] = level, growth
    covariance[0], covariance[1], covariance[2] = p00, p01, p11
    return state, covariance, ln_likelihood - 0.5 * squares


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
    number = densities.size
    most = min(MOST_BEFORE, t.size // 3)
    trends = (most + 1) * number
    firsts, every = np.empty(trends, np.int64), np.empty(trends)
    for i in range(trends):
        firsts[i], every[i] = i // number, densities[i % number]
    _, _, ln_likelihood = filtered(t, m, variance, np.zeros(trends), every, firsts)
    still, best, highest = 0.0, 0, -np.inf
    for first in range(most + 1):
        if first > 0:
            still -= 0.5 * (log(variance) + m[first - 1] * m[first - 1] / variance)
        total = still + np.max(ln_likelihood[first * number : (first + 1) * number])
        if total > highest:
            best, highest = first, total
    return best


@compiled
def reached(
    ahead: Array, weights: Array, state: Array, covariance: Array, rates: Array, densities: Array,
    left: float, doubt_below: float, doubt_above: float,
) -> Array:  # fmt: skip
    """Return the probability that the level has reached a limit, at times ahead.

    Parameters
    ----------
    ahead : ndarray, shape (n,)
        Times from the last level on, rising [records].
    weights : ndarray, shape (k,)
        Probability of each trend.
    state : ndarray, shape (2, k)
        Level and growth at the last time.
    covariance : ndarray, shape (3, k)
        Variance of the level, covariance, variance of the growth.
    rates, densities : ndarray, shape (k,)
        lambda and q of the trends.
    left : float
        The limit.
    doubt_below, doubt_above : float
        Standard deviations by which the limit may be lower and higher, relative to it.

    Returns
    -------
    ndarray, shape (n,)
        Probabilities; they do not fall.
    """
    likely = np.nonzero(weights > NEGLIGIBLE)[0]
    whole = np.sum(weights[likely])
    found = np.ones(ahead.size)
    highest = 0.0
    for k in range(ahead.size):
        total = 0.0
        for i in likely:
            share, _, q00, _, _ = spread(ahead[k], rates[i])
            above = state[0, i] + share * state[1, i] - left
            doubt = left * (doubt_above if above > 0.0 else doubt_below)
            variance = (
                covariance[0, i]
                + 2.0 * share * covariance[1, i]
                + share * share * covariance[2, i]
                + densities[i] * q00
                + doubt * doubt
            )
            total += weights[i] * _normal(above / sqrt(variance))
        highest = max(highest, total / whole)
        if highest > SURE:
            break
        found[k] = highest
    return found


@compiled
def _normal(z: float) -> float:
    """Return the normal distribution function."""
    if abs(z) > FAR:
        return 1.0 if z > 0.0 else 0.0
    return 0.5 * erfc(-z / sqrt(2.0))


@compiled
def smoothed(values: Array, kernel: Array) -> Array:
    """Return the mean of values over their neighbours.

    Parameters
    ----------
    values : ndarray, shape (n,)
        Values; the first and the last go on beyond the ends.
    kernel : ndarray, shape (2 w + 1,)
        Weights from w places before to w places after.

    Returns
    -------
    ndarray, shape (n,)
        Means.
    """
    found = np.zeros(values.size)
    half = kernel.size // 2
    for k in range(values.size):
        for j in range(kernel.size):
            found[k] += kernel[j] * values[min(max(k + j - half, 0), values.size - 1)]
    return found
