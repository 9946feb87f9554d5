"""Whether a motor's standing asymmetry is more than its sensors and a sound winding leave."""

from dataclasses import dataclass
from math import hypot, sqrt
from typing import Final

import numpy as np

from core.condition.changes.evidence import of_size
from core.condition.changes.mixture import interval_of
from core.condition.changes.naming import log_share
from core.condition.complex_parts import inverse, symmetric
from core.condition.filter.state import ComplexArray
from core.condition.following.standing_errors import StandingErrors
from core.condition.measuring.turns_grid import TurnsGrid
from core.diagnosis.channel_errors import A
from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled

STANDING_SCORE: Final = 3.7
"""Standard deviations beyond which a standing asymmetry is no sound motor's: one motor in a thousand."""
STANDING_LEVEL: Final = 0.05
"""Usual size of a standing fault: so wide that it hardly counts."""
LOOKED_AT: Final = 8
"""Every so many records it is looked whether a standing fault is to be called."""
DEAD_BAND: Final = 0.5
"""By how much a score has to fall before it counts as lower: what it wanders by says nothing."""
NEGLIGIBLE: Final = 12.0
"""Axes and leakages with so much less evidence than the best are left out."""
UNLIKELY: Final = 1e-4
"""Probability below which the score leaves them out."""
USUAL_SCORE: Final = 2.0
"""Score that one sound motor in ten reaches."""


@dataclass(slots=True)
class Called:
    """A standing fault that was called, as the records told it surest.

    Parameters
    ----------
    errors : StandingErrors
        The standing errors then.
    score : float
        Standard deviations by which they lay above what a sound motor with such sensors shows.
    above : float
        Highest of the levels that were likeliest with them, a fraction of the phase turns.
    """

    errors: StandingErrors
    score: float
    above: float


@dataclass(frozen=True, slots=True)
class Standing:
    """Shorted turns that would explain the standing asymmetry best.

    Parameters
    ----------
    level, deviation : float
        Level and its standard deviation from all causes, a fraction of the phase turns.
    winding : int
        Likeliest winding of the winding frame.
    windings : tuple of float
        Probability of each.
    axes_rad, axis_shares : ndarray
        Axes of the coils in that frame [rad], and the probability of each in that winding.
    score : float
        Standard deviations by which it lies above what a sound motor with such sensors shows.
    from_bus : bool
        Whether other motors of the bus took part in judging it.
    interval : tuple of float
        95 % interval of the level over all that explains the asymmetry, not below zero.
    """

    level: float
    deviation: float
    winding: int
    windings: tuple[float, float, float]
    axes_rad: Array
    axis_shares: Array
    score: float
    from_bus: bool
    interval: tuple[float, float]


def held(score: float, before: float) -> float:
    """Return a score that does not follow another down until that has fallen by the dead band.

    Parameters
    ----------
    score : float
        The score now.
    before : float
        What this function returned last.

    Returns
    -------
    float
        The held score, not below the score and at most the dead band above it.
    """
    return min(max(score, before), score + DEAD_BAND)


def score_of(grid: TurnsGrid, errors: StandingErrors) -> float:
    """Return by how many standard deviations errors lie above what a sound motor shows.

    Parameters
    ----------
    grid : TurnsGrid
        What shorted turns look like.
    errors : StandingErrors
        The standing errors, judged without a bus.

    Returns
    -------
    float
        The score of `standing_of`.
    """
    asymmetry = np.array([errors.real, errors.imaginary])
    return _score(asymmetry, symmetric(errors.spread), grid.y, grid.usual)


def surest(grid: TurnsGrid, errors: StandingErrors, score: float, called: Called | None) -> Called | None:
    """Call a standing fault where the score is high enough, or surer than it was called before.

    It does not depend on the motor's limit: a limit that is edited later counts for all records alike.

    Parameters
    ----------
    grid : TurnsGrid
        What shorted turns look like.
    errors : StandingErrors
        The standing errors, judged without a bus.
    score : float
        Their score.
    called : Called or None
        The standing fault that was called before.

    Returns
    -------
    Called or None
        The standing fault, as it was told surest.
    """
    if score < STANDING_SCORE or (called is not None and score <= called.score):
        return called
    asymmetry = np.array([errors.real, errors.imaginary])
    level = standing_of(grid, asymmetry, symmetric(errors.spread), from_bus=False).level
    return Called(errors, score, max(level, 0.0 if called is None else called.above))


def standing_of(grid: TurnsGrid, asymmetry: Array, covariance: Array, *, from_bus: bool) -> Standing:
    """Judge a standing asymmetry.

    Parameters
    ----------
    grid : TurnsGrid
        What shorted turns look like.
    asymmetry : ndarray, shape (2,)
        Real and imaginary part of the asymmetry, estimated without a prior.
    covariance : ndarray, shape (2, 2)
        Covariance of what it would be in a sound motor, its estimation error included.
    from_bus : bool
        Whether other motors of the bus took part in it.

    Returns
    -------
    Standing
        The likeliest shorted turns.
    """
    logs, sizes, deviations = _explained(
        asymmetry, covariance, grid.y, grid.direction, grid.scale, grid.shares
    )
    held = np.flatnonzero(logs > -NEGLIGIBLE)
    shares = np.exp(logs[held])
    shares /= shares.sum()
    windings, nodes = np.divmod(held, grid.y.size)
    a, b, c = np.bincount(windings, shares, 3).tolist()
    winding = int(np.argmax([a, b, c]))
    mine = windings == winding
    axes, inverse = np.unique(grid.axis_rad[nodes[mine]], return_inverse=True)
    weights = shares[mine] / shares[mine].sum()
    level = float(weights @ sizes[held][mine])
    spread = deviations[held][mine] ** 2 + (sizes[held][mine] - level) ** 2
    low, high = interval_of(shares, sizes[held], deviations[held])
    return Standing(
        level=level,
        deviation=float(np.sqrt(weights @ spread)),
        winding=winding,
        windings=(a, b, c),
        axes_rad=axes,
        axis_shares=np.bincount(inverse, weights).astype(np.float64),
        score=_score(asymmetry, covariance, grid.y, grid.usual),
        from_bus=from_bus,
        interval=(max(0.0, min(low, level)), max(0.0, high, level)),
    )


@compiled
def _score(asymmetry: Array, covariance: Array, y: ComplexArray, usual: Array) -> float:
    """Return the standard deviations by which an asymmetry lies in the direction that explains it best."""
    W = inverse(covariance)
    score = -1.0
    for winding in range(3):
        turn = A**winding
        for n in range(y.size):
            if usual[n] < UNLIKELY:
                continue
            u = turn * y[n]
            u0, u1 = u.real * W[0, 0] + u.imag * W[1, 0], u.real * W[0, 1] + u.imag * W[1, 1]
            along, information = u0 * asymmetry[0] + u1 * asymmetry[1], u0 * u.real + u1 * u.imag
            score = max(score, along / sqrt(information))
    return score


@compiled
def _explained(
    asymmetry: Array, covariance: Array, y: ComplexArray, directions: Array, scales: Array,
    level_shares: Array,
) -> tuple[Array, Array, Array]:  # fmt: skip
    """Return of each winding and node the log of its weight over the greatest, the size and its deviation."""
    W = inverse(covariance)
    number = 3 * y.size
    logs, sizes, deviations = np.empty(number), np.empty(number), np.empty(number)
    for k in range(number):
        n = k % y.size
        u = A ** (k // y.size) * y[n]
        p, q = u.real, u.imag
        # U' W for the size and across it, U = [[p, -q], [q, p]]
        u0, u1 = p * W[0, 0] + q * W[1, 0], p * W[0, 1] + q * W[1, 1]
        v0, v1 = p * W[1, 0] - q * W[0, 0], p * W[1, 1] - q * W[0, 1]
        evidence, size, deviation = of_size(
            u0 * p + u1 * q,
            u1 * p - u0 * q,
            v1 * p - v0 * q,
            u0 * asymmetry[0] + u1 * asymmetry[1],
            v0 * asymmetry[0] + v1 * asymmetry[1],
            STANDING_LEVEL,
            directions[n],
            one_sided=True,
        )
        sizes[k], deviations[k] = size, hypot(deviation, scales[n] * size)
        logs[k] = evidence + log_share(size, n, level_shares)
    return logs - np.max(logs), sizes, deviations
