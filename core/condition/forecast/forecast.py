"""How fast the level of shorted turns grows, and when it reaches a limit.

The level m and its growth g follow one of 35 trends. Between records that are h apart,

    m' = m + g (e^{lambda h} - 1) / lambda + noise      g' = g e^{lambda h} + noise,

where noise is that of a growth that wanders with density q: lambda = 0 and q = 0 is a straight line,
lambda > 0 a growth that feeds itself. A Kalman filter gives each trend its likelihood, and the time to the
limit is that of their mixture. Times are counted in mean distances of the records, so that the same trends
suit hourly and daily records.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt
from typing import Final

import numpy as np
from numpy.typing import NDArray

from core.condition.assessment import NORMAL_95, Level
from core.condition.forecast.trends import filtered, moved, onset
from core.units import NANOSECONDS_PER_DAY

Array = NDArray[np.float64]

RATES: Final = 1.0 / np.array([np.inf, 400.0, 250.0, 160.0, 100.0, 65.0, 40.0])
"""lambda: growth of the growth, a record."""

DENSITIES: Final = 1e-4 * np.array([0.0, 1e-8, 1e-7, 1e-6, 1e-5])
"""q: variance that the growth gains with each record."""

STEADY_SHARE: Final = 0.6
"""Prior probability of trends whose growth does not feed itself."""

QUANTILES: Final = (0.05, 0.5, 0.95)
"""Published as an interval of 80 %, because no motor follows one of these trends."""

FEWEST: Final = 4
"""With fewer records there is no telling growth from scatter."""

FEW: Final = 8.0
"""So many records tell their own variance within about half; it is taken as larger where there are few."""

MEDIAN_OF_SQUARES: Final = 0.4549
"""Median of the square of a standard normal variable."""

SCALE_STEPS: Final = np.linspace(-2.0, 2.0, 7)
SCALE_WEIGHTS: Final = np.exp(-(SCALE_STEPS**2) / 2.0) / np.sum(np.exp(-(SCALE_STEPS**2) / 2.0))
"""Standard deviations by which today's level is another, and the probability of each."""

SCALE_SPREAD: Final = 1.3
"""Its interval is taken as so much wider: where the path is another, all levels err in one direction."""

GROWTH_DOUBT: Final = 0.25
"""Relative standard deviation of the growth ahead beside that seen: no fault is a line, and what the
reference took in at the beginning makes a growth look steeper."""

LEAST_SCALE: Final = 0.05
NEGLIGIBLE: Final = 1e-4
"""Trends of less probability are left out."""

LEAST_VARIANCE: Final = 1e-14

LONGEST_DAYS: Final = 3650.0
"""A limit that is not reached in ten years for sure is no trend."""

STEPS: Final = 120
"""Number of times at which the mixture is computed."""

_LAMBDA, _Q = (grid.ravel() for grid in np.meshgrid(RATES, DENSITIES, indexing="ij"))
_LN_PRIOR = np.log(
    np.where(
        _LAMBDA == 0.0,
        STEADY_SHARE / DENSITIES.size,
        (1.0 - STEADY_SHARE) / (DENSITIES.size * (RATES.size - 1)),
    )
)


@dataclass(frozen=True, slots=True)
class Forecast:
    """Growth of the level, and the time until it reaches a limit.

    Parameters
    ----------
    limit : float
        Level that is asked for, a fraction of the phase turns.
    days : tuple of float or None
        Time from the latest record until the limit: it is earlier than the first and later than the last
        with one chance in ten each, and as likely before as after the middle one [days]. None where the
        records show no trend towards the limit.
    growth_per_day : float or None
        Growth of the level today, a fraction of the phase turns a day; None where nothing changes, and
        where there are too few records to tell.
    """

    limit: float
    days: tuple[float, float, float] | None = None
    growth_per_day: float | None = None


def limit_ahead(level: float, limit: float) -> float:
    """Return the limit that a level has yet to reach: the motor's own, or the next doubling of it.

    Parameters
    ----------
    level : float
        Level today, a fraction of the phase turns.
    limit : float
        The motor's limit, a fraction of the phase turns.

    Returns
    -------
    float
        The limit.
    """
    while limit <= level:
        limit *= 2.0
    return limit


def forecast(
    levels: Sequence[tuple[int, float]],
    limit: float,
    *,
    today: Level | None = None,
    standing: float = 0.0,
) -> Forecast:
    """Tell when a level that changes reaches a limit.

    Parameters
    ----------
    levels : sequence of tuple of int and float
        Time [ns] and change of the level at each record, oldest first.
    limit : float
        The limit, a fraction of the phase turns.
    today : Level or None, optional
        Change of the level today from all that is known, with its interval. The levels are scaled to it:
        single ones are those of the likeliest path, and another path would scale them all. None where they
        are taken as they are.
    standing : float, optional
        Level before the change, which adds to it.

    Returns
    -------
    Forecast
        Growth and time.
    """
    # Times are subtracted as integers, because a float does not hold them to the second.
    times_ns = np.array([time_ns for time_ns, _ in levels], dtype=np.int64)
    if times_ns.size < FEWEST or times_ns[-1] <= times_ns[0]:
        return Forecast(limit)
    days = (times_ns - times_ns[-1]) / NANOSECONDS_PER_DAY
    spacing_days = float(-days[0] / (days.size - 1))
    t = days / spacing_days
    m = np.array([level for _, level in levels])
    scatter = _variance(t, m)
    first = onset(t, m, scatter, _Q[_LAMBDA == 0.0])
    state, covariance, ln_likelihood = filtered(t[first:], m[first:], scatter, _LAMBDA, _Q)
    weight = np.exp(ln_likelihood + _LN_PRIOR - np.max(ln_likelihood + _LN_PRIOR))
    weight /= weight.sum()
    scales = _scales(float(weight @ state[:, 0]), today)
    likely = weight > NEGLIGIBLE
    # Steps grow with the time itself, from a hundredth of a record on.
    horizon = max(LONGEST_DAYS / spacing_days, 0.02)
    ahead = np.concatenate(([0.0], np.geomspace(0.01, horizon, STEPS - 1)))
    mean, variance = moved(ahead, state[likely], covariance[likely], _LAMBDA[likely], _Q[likely])
    variance += (GROWTH_DOUBT * (mean - mean[:, :1])) ** 2
    # A level that is s times as large reaches the limit when this one reaches what is left over s.
    left = ((limit - standing) / scales)[:, np.newaxis, np.newaxis]
    reached = SCALE_WEIGHTS @ (weight[likely] @ _normal((mean - left) / np.sqrt(variance)))
    return Forecast(
        limit,
        days=_quantiles(np.maximum.accumulate(reached), ahead * spacing_days),
        growth_per_day=float(scales[SCALE_STEPS.size // 2]) * float(weight @ state[:, 1]) / spacing_days,
    )


def _scales(level: float, today: Level | None) -> Array:
    """Return by which factors the levels may have to be taken, from the interval of today's."""
    if today is None or level <= 0.0 or today.value <= 0.0:
        return np.ones(SCALE_STEPS.size)
    low, high = today.ci95
    spread = np.where(SCALE_STEPS < 0.0, today.value - low, high - today.value) * SCALE_SPREAD / NORMAL_95
    return np.maximum((today.value + SCALE_STEPS * spread) / level, LEAST_SCALE)


def _variance(t: Array, m: Array) -> float:
    """Return the variance of single levels, from how far each lies beside the line through its neighbours.

    It is that of the median, so that a step in the levels is not taken for scatter.
    """
    share = (t[1:-1] - t[:-2]) / np.maximum(t[2:] - t[:-2], 1e-9)
    beside = m[1:-1] - (1.0 - share) * m[:-2] - share * m[2:]
    squares = beside**2 / (1.0 + share**2 + (1.0 - share) ** 2)
    return max(float(np.median(squares)) / MEDIAN_OF_SQUARES * (1.0 + FEW / t.size), LEAST_VARIANCE)


def _quantiles(reached: Array, days: Array) -> tuple[float, float, float] | None:
    if reached[-1] < QUANTILES[-1]:
        return None
    low, mid, high = (float(np.interp(share, reached, days)) for share in QUANTILES)
    return low, mid, high


def _normal(z: Array) -> Array:
    """Return the normal distribution function, by an approximation of 1.5e-7 (Abramowitz, Stegun 7.1.26)."""
    x = np.abs(z) / sqrt(2.0)
    s = 1.0 / (1.0 + 0.3275911 * x)
    polynomial = s * (
        0.254829592 + s * (-0.284496736 + s * (1.421413741 + s * (-1.453152027 + s * 1.061405429)))
    )
    erf = 1.0 - polynomial * np.exp(-x * x)
    return 0.5 * (1.0 + np.sign(z) * erf)
