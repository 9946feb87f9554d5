"""Fault level since a change, record by record and now."""

from math import exp, log

import numpy as np

from core.condition.filter.kalman import TEMPERATURE
from core.condition.filter.state import FilterState, Recent
from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled

WANDERS = (0.0, 1e-10, 1e-9, 1e-8, 1e-7)
"""Variances by which a level may wander from record to record that are tried."""
FIRST_SPREAD = 0.1
ODD, ODD_AMONG = 4.0, 5
"""Standard deviations beyond which a level is odd, and levels in a row of which it is one."""


@compiled
def levels_since(
    state: FilterState, recent: list[Recent], reference: Array, u: complex, onset_ns: int, out: Array
) -> int:
    """Compute the change of the fault level in each of the records since a change.

        m_k = Re(conj(u) (y_k - H_k x)) / |u|^2

    Parameters
    ----------
    state : FilterState
        The filter.
    recent : array of Recent
        Latest records, or means of several.
    reference : ndarray, shape (7,)
        State before the change.
    u : complex
        What shorted turns add to y, per level.
    onset_ns : int
        Time of the change, UTC [ns].
    out : ndarray, shape (RECENT, 3)
        Filled with the level, the variance of its noise, and the number of records in each.

    Returns
    -------
    int
        Number of records before the change in `recent`: the first of them that `out` holds.
    """
    x = reference
    first = 0
    square = u.real**2 + u.imag**2
    for i in range(int(state.recent)):
        one = recent[i]
        if one.time_ns < onset_ns:
            first = i + 1
            continue
        rest = one.y - complex(x[0], x[1]) - complex(x[2], x[3]) * one.j1 - complex(x[4], x[5]) * one.j2
        warm = TEMPERATURE * (u.conjugate() * one.j2).real / square
        out[i - first, 0] = (u.conjugate() * rest).real / square
        out[i - first, 1] = one.R / one.count / square + warm * warm
        out[i - first, 2] = one.count
    return first


@compiled
def without_odd(levels: Array) -> None:
    """Put the median of five in a row in the place of a level that lies far beside it: of an odd record.

    Parameters
    ----------
    levels : ndarray, shape (n, 3)
        Level, variance and number of records; the levels change.
    """
    number = levels.shape[0]
    if number < ODD_AMONG:
        return
    before = levels[:, 0].copy()
    for i in range(number):
        first = min(max(i - ODD_AMONG // 2, 0), number - ODD_AMONG)
        median = np.median(before[first : first + ODD_AMONG])
        if (before[i] - median) ** 2 > ODD**2 * levels[i, 1]:
            levels[i, 0] = median


@compiled
def level_now(levels: Array) -> tuple[float, float]:
    """Return the level at the latest record, however it has grown.

    Parameters
    ----------
    levels : ndarray, shape (n, 3)
        Level, variance and number of records.

    Returns
    -------
    level, variance : float
        Mean and variance over local levels that wander by several variances, each as likely as the records
        say; the variance is what wandering adds to that of a constant level.
    """
    logs, means, variances = np.zeros(len(WANDERS)), np.zeros(len(WANDERS)), np.zeros(len(WANDERS))
    for w in range(len(WANDERS)):
        mean, variance, total = 0.0, FIRST_SPREAD**2, 0.0
        for i in range(levels.shape[0]):
            variance += WANDERS[w] * levels[i, 2]
            S = variance + levels[i, 1]
            nu = levels[i, 0] - mean
            total -= 0.5 * (nu * nu / S + log(S))
            mean += variance / S * nu
            variance *= levels[i, 1] / S
        logs[w], means[w], variances[w] = total, mean, variance
    highest = np.max(logs)
    total = mean = 0.0
    for w in range(len(WANDERS)):
        share = exp(logs[w] - highest)
        total += share
        mean += share * means[w]
    mean /= total
    variance = 0.0
    for w in range(len(WANDERS)):
        share = exp(logs[w] - highest) / total
        variance += share * (variances[w] - variances[0] + (means[w] - mean) ** 2)
    return mean, variance
