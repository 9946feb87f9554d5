"""Whether a motor's standing asymmetry is more than its sensors and a sound winding leave."""

from dataclasses import dataclass
from functools import lru_cache
from math import hypot, log, sqrt
from typing import Final

import numpy as np

from core.condition.changes.evidence import of_size
from core.condition.changes.hypotheses import (
    MACHINE,
    PATH_SHARES,
    RESISTANCE,
    STATOR,
    TURNS_DIRECTION,
)
from core.condition.changes.mixture import interval_of
from core.condition.complex_parts import inverse, symmetric
from core.condition.following.standing_errors import StandingErrors
from core.condition.measuring.signatures import (
    PATHS,
    shorted_turns,
    turns_angle_slope,
    turns_size_slope,
)
from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled
from core.machines.parameters import Motor

STANDING_SCORE: Final = 3.7
"""Standard deviations beyond which a standing asymmetry is no sound motor's: one motor in a thousand."""
STANDING_LEVEL: Final = 0.05
"""Usual size of a standing fault: so wide that it hardly counts."""
LOOKED_AT: Final = 8
"""Every so many records it is looked whether a standing fault is to be called."""
DEAD_BAND: Final = 0.5
"""By how much a score has to fall before it counts as lower: what it wanders by says nothing."""
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
        Winding of the winding frame.
    path_ratio : float
        Resistance of the path over that of the shorted turns.
    score : float
        Standard deviations by which it lies above what a sound motor with such sensors shows.
    from_bus : bool
        Whether other motors of the bus took part in judging it.
    interval : tuple of float
        95 % interval of the level over all windings and paths that explain the asymmetry, not below zero.
    """

    level: float
    deviation: float
    winding: int
    path_ratio: float
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


def score_of(motor: Motor, errors: StandingErrors) -> float:
    """Return by how many standard deviations errors lie above what a sound motor shows.

    Parameters
    ----------
    motor : Motor
        The motor.
    errors : StandingErrors
        The standing errors, judged without a bus.

    Returns
    -------
    float
        The score of `standing_of`.
    """
    asymmetry = np.array([errors.real, errors.imaginary])
    return _likeliest(asymmetry, symmetric(errors.spread), _shown_by(motor)[0])[3]


def surest(motor: Motor, errors: StandingErrors, score: float, called: Called | None) -> Called | None:
    """Call a standing fault where the score is high enough, or surer than it was called before.

    It does not depend on the motor's limit: a limit that is edited later counts for all records alike.

    Parameters
    ----------
    motor : Motor
        The motor.
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
    level = standing_of(motor, asymmetry, symmetric(errors.spread), from_bus=False).level
    return Called(errors, score, max(level, 0.0 if called is None else called.above))


def standing_of(motor: Motor, asymmetry: Array, covariance: Array, *, from_bus: bool) -> Standing:
    """Judge a standing asymmetry.

    Parameters
    ----------
    motor : Motor
        The motor.
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
    directions, tolerances = _shown_by(motor)
    best, level, deviation, score = _likeliest(asymmetry, covariance, directions)
    # Several windings and paths may explain an asymmetry as well.
    logs, sizes, deviations = _explained(asymmetry, covariance, directions, tolerances)
    shares = np.exp(logs)
    low, high = interval_of(shares / shares.sum(), sizes, deviations)
    return Standing(
        level=level,
        deviation=deviation,
        winding=best // len(PATHS),
        path_ratio=PATHS[best % len(PATHS)],
        score=score,
        from_bus=from_bus,
        interval=(max(0.0, min(low, level)), max(0.0, high, level)),
    )


@compiled
def _likeliest(asymmetry: Array, covariance: Array, directions: Array) -> tuple[int, float, float, float]:
    """Return the direction that explains an asymmetry best, with size, deviation and score."""
    W = inverse(covariance)
    best, size, deviation, score = 0, 0.0, 0.0, -1.0
    for n in range(directions.shape[0]):
        x, y = directions[n]
        u0, u1 = x * W[0, 0] + y * W[1, 0], x * W[0, 1] + y * W[1, 1]
        along, information = u0 * asymmetry[0] + u1 * asymmetry[1], u0 * x + u1 * y
        if along / sqrt(information) > score:
            best, score = n, along / sqrt(information)
            size, deviation = along / information, 1.0 / sqrt(information)
    return best, size, deviation, score


@lru_cache(maxsize=256)
def _shown_by(motor: Motor) -> tuple[Array, Array]:
    """Return what shorted turns add to E, by winding and path, and how surely.

    The first array has real and imaginary part, the second how sure the direction is, how sure the size is,
    and the log of the path's share before.
    """
    directions, tolerances = [], []
    for winding in range(3):
        for p, share in zip(PATHS, PATH_SHARES, strict=True):
            u = shorted_turns(motor, winding, p)
            directions.append([u.real, u.imag])
            direction = hypot(TURNS_DIRECTION, STATOR * turns_angle_slope(motor, p))
            scale = hypot(MACHINE, RESISTANCE * turns_size_slope(motor, p))
            tolerances.append([direction, scale, log(share)])
    return np.array(directions), np.array(tolerances)


@compiled
def _explained(
    asymmetry: Array, covariance: Array, directions: Array, tolerances: Array
) -> tuple[Array, Array, Array]:
    """Return of each direction the log of its weight over the greatest, the size and its deviation."""
    W = inverse(covariance)
    number = directions.shape[0]
    logs, sizes, deviations = np.empty(number), np.empty(number), np.empty(number)
    for n in range(directions.shape[0]):
        x, y = directions[n]
        direction, scale, share = tolerances[n]
        # U' W for the size and across it, U = [[x, -y], [y, x]]
        u0, u1 = x * W[0, 0] + y * W[1, 0], x * W[0, 1] + y * W[1, 1]
        v0, v1 = x * W[1, 0] - y * W[0, 0], x * W[1, 1] - y * W[0, 1]
        evidence, size, deviation = of_size(
            u0 * x + u1 * y,
            u1 * x - u0 * y,
            v1 * x - v0 * y,
            u0 * asymmetry[0] + u1 * asymmetry[1],
            v0 * asymmetry[0] + v1 * asymmetry[1],
            STANDING_LEVEL,
            direction,
            one_sided=True,
        )
        logs[n], sizes[n], deviations[n] = evidence + share, size, hypot(deviation, scale * size)
    return logs - np.max(logs), sizes, deviations
