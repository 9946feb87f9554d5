"""How fast the level of shorted turns grows, and when it reaches a limit.

The level m and its growth g follow one of 35 trends. Between records that are h apart,

    m' = m + g (e^{lambda h} - 1) / lambda + noise      g' = g e^{lambda h} + noise,

where noise is that of a growth that wanders with density q: lambda = 0 and q = 0 is a straight line,
lambda > 0 a growth that feeds itself. A Kalman filter gives each trend its likelihood, and the time to the
limit is that of their mixture. Times are counted in mean distances of the records, so that the same trends
suit hourly and daily records.

Three doubts widen it, because no motor follows one of these trends: the level may be another by a factor,
the records may have drifted, and the growth ahead may be faster or slower than that seen.
"""

from collections.abc import Sequence
from math import log
from typing import Final

import numpy as np
from numpy.typing import NDArray

from core.condition.assessment import Level
from core.condition.forecast.outcome import HORIZONS_DAYS, Forecast
from core.condition.forecast.trends import filtered, onset, reached, scatter, smoothed
from core.normal_distribution import NORMAL_95
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

DRIFT: Final = 0.1
"""Standard deviation of what the levels may have drifted since the onset without growth, relative to the
level: what shorted turns show changes with the temperature and the load."""

TIME_DOUBT: Final = 0.4
"""Standard deviation of the log of the factor by which the time to the limit is another, because the growth
ahead is not that seen."""

HIGHER_SHARE: Final = 0.7
"""Share of the way to the upper end of today's level that is taken: a level is rather told too high, because
the path is taken for worse than it is where records cannot tell it."""

LEAST_SHARE: Final = 0.1
"""The level is at least so much of what it seems."""

LONGEST_DAYS: Final = 3650.0
"""A limit that is not reached in ten years for sure is no trend."""

SHORTEST: Final = 0.1
"""First of the times at which the mixture is computed [records]."""

CALIBRATION: Final = 0.65
"""Power of the mixture's probability that is told as the chance of a level that is scaled to today's. Of
simulated ones that the mixture gave 5, 10, 20 and 50 % to reach their limit by a day, 13, 21, 36 and 67 %
had: it is too sure, because the path of the turns is another than the records tell."""

CHANCE_DIGITS: Final = 4
"""A chance is known no better."""

STEP: Final = TIME_DOUBT / 2.0
"""Log of the ratio of each of these times to the one before."""

_KERNEL = np.exp(-0.5 * (np.arange(-6, 7) * STEP / TIME_DOUBT) ** 2)
_KERNEL /= _KERNEL.sum()
_LAMBDA, _Q = (grid.ravel() for grid in np.meshgrid(RATES, DENSITIES, indexing="ij"))
_LN_PRIOR = np.log(
    np.where(
        _LAMBDA == 0.0,
        STEADY_SHARE / DENSITIES.size,
        (1.0 - STEADY_SHARE) / (DENSITIES.size * (RATES.size - 1)),
    )
)


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
    variance = scatter(t, m)
    first = onset(t, m, variance, DENSITIES)
    state, covariance, ln_likelihood = filtered(
        t, m, variance, _LAMBDA, _Q, np.full(_LAMBDA.size, first, dtype=np.int64)
    )
    weight = np.exp(ln_likelihood + _LN_PRIOR - np.max(ln_likelihood + _LN_PRIOR))
    weight /= weight.sum()
    covariance[2] += (DRIFT * state[0] / max(-t[first], 1.0)) ** 2
    scale, below, above = _scale(float(weight @ state[0]), today)
    ahead = _times(LONGEST_DAYS / spacing_days)
    likely = reached(ahead, weight, state, covariance, _LAMBDA, _Q, (limit - standing) / scale, below, above)
    # The growth ahead is faster or slower than that seen.
    doubted = smoothed(likely, _KERNEL)
    return Forecast(
        limit,
        days=_quantiles(doubted, ahead * spacing_days),
        growth_per_day=scale * float(weight @ state[1]) / spacing_days,
        chances=_chances(doubted if today is None else doubted**CALIBRATION, ahead * spacing_days),
    )


def _scale(level: float, today: Level | None) -> tuple[float, float, float]:
    """Return by which factor the levels are to be taken, and the doubts of it.

    A level that is s times as large reaches the limit when this one reaches what is left over s. So the
    doubts are those of 1/s: to the side where the limit is reached later, and to that where it is earlier.
    """
    if today is None or level <= 0.0 or today.value <= 0.0:
        return 1.0, 0.0, 0.0
    low, high = today.ci95
    later = today.value / max(low, LEAST_SHARE * today.value) - 1.0
    earlier = 1.0 - today.value / max(high, today.value)
    return today.value / level, HIGHER_SHARE * earlier / NORMAL_95, max(later, 0.0) / NORMAL_95


def _times(longest: float) -> Array:
    """Return the times at which the mixture is computed: now, and then each later by the same ratio."""
    number = max(int(log(longest / SHORTEST) / STEP), 1) + 2 if longest > SHORTEST else 2
    return np.concatenate(([0.0], SHORTEST * np.exp(STEP * np.arange(number))))


def _quantiles(doubted: Array, days: Array) -> tuple[float, float, float] | None:
    """Return when the limit is reached with each probability."""
    if doubted[-1] < QUANTILES[-1]:
        return None
    low, mid, high = (float(np.interp(share, doubted, days)) for share in QUANTILES)
    return low, mid, high


def _chances(doubted: Array, days: Array) -> tuple[float, ...]:
    """Return how likely the limit is reached by each of the times that are kept."""
    found = np.interp(HORIZONS_DAYS, days, doubted)
    return tuple(round(float(one), CHANCE_DIGITS) for one in found)
