"""Whether a motor's standing asymmetry is more than its sensors and a sound winding leave."""

from dataclasses import dataclass
from functools import lru_cache
from math import hypot, log, sqrt
from typing import Final

import numpy as np

from core.condition.changes.before_change import before_change
from core.condition.changes.evidence import of_size
from core.condition.changes.hypotheses import (
    MACHINE,
    PATH_SHARES,
    RESISTANCE,
    STATOR,
    TURNS_DIRECTION,
)
from core.condition.changes.mixture import interval_of
from core.condition.complex_parts import symmetric
from core.condition.filter.kalman import WANDER_EC
from core.condition.filter.prior import IMPEDANCE
from core.condition.filter.state import V2, Candidate, FilterState, SideState
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
SUSPECTED: Final = 3.0
"""Log of the detector's statistic above which a change is likely enough not to be taken for what stands."""
WANDER_VARIANCE: Final = WANDER_EC**2
VARIES: Final = 0.04
"""Standard deviation by which Z2 varies with load and temperature over |Z2|."""
WANDERS_OVER: Final = 16.0
"""Number of records over which the supply's wander is taken to add up: it does not wander off for good."""


@dataclass(frozen=True, slots=True)
class StandingErrors:
    """E as the records alone tell it, and how the voltages differ from the bus's.

    Parameters
    ----------
    real, imaginary : float
        E.
    spread : list of float
        Covariance of what a sound motor shows: its elements 00, 01, 11.
    prior : list of float
        The part of it that is there before any record.
    difference_real, difference_imaginary : float
        By how much V2/V1 of the terminals exceeds the mean of the bus.
    others : int
        Number of other motors in it.
    transformers : int
        Number of voltage transformers that they and this motor have.
    """

    real: float
    imaginary: float
    spread: list[float]
    prior: list[float]
    difference_real: float
    difference_imaginary: float
    others: int
    transformers: int


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
def of_records(
    filters: list[FilterState], bank: list[Candidate], sides: list[SideState], voltage: Array
) -> tuple[tuple[float, float], tuple[float, float, float], tuple[float, float, float]]:
    """Return E as the records alone tell it, without the prior.

    Z2 varies with load and temperature. Where V2 is constant the currents vary with it, and the regression on
    them tells Z2 = 0, an error of one, however little Z2 varies. Beside a supply that changes it is wrong by
    the share S_t / (S_t + S_v), for the variances that Z2 and V2 make of w, and E by that times w. Where this
    leaves E less certain than what is known of any motor's impedance, E is told with that.

    Parameters
    ----------
    filters : array of FilterState, shape (1,)
        The filter.
    bank : array of Candidate
        Candidates. Where a change is likely, what the filter has taken up of it is not what stands.
    sides : array of SideState
        Side channels; v2 tells how much the supply changes.
    voltage : ndarray, shape (2, 2)
        Covariance that E started from, about zero.

    Returns
    -------
    estimate : tuple of float
        E, its real and imaginary part.
    spread, prior : tuple of float
        P0 + N, which is the covariance of what a sound motor shows, and the prior's spread P0 that is part of
        it: their elements 00, 01, 11.
    """
    state = filters[0]
    x, P = state.x.copy(), state.P.copy()
    if state.statistic > SUSPECTED:
        x, P = before_change(state, bank)
    prior = voltage.copy()
    for i in range(2):
        prior[i, i] += WANDER_VARIANCE * state.records
    found, spread = _without_prior(x[:2].copy(), P[:2, :2].copy(), prior)
    square = state.w.real**2 + state.w.imag**2
    share = VARIES**2 * square / (VARIES**2 * square + WANDERS_OVER * sides[V2].q)
    spread += share**2 * square * np.eye(2)

    # E where the error of Z2 is zero, and how it depends on that.
    slope = P[:2, 4:6].copy() @ _inverse(P[4:6, 4:6])
    known = P[:2, :2] - slope @ P[4:6, :2].copy()
    usual, usual_spread = _without_prior(x[:2] - slope @ x[4:6], known, prior)
    slope, _ = _without_prior(slope, known, prior)
    usual_spread += IMPEDANCE**2 * slope @ slope.T
    if np.trace(usual_spread) < np.trace(spread):
        found, spread = usual, usual_spread
    return (
        (found[0], found[1]),
        (spread[0, 0], spread[0, 1], spread[1, 1]),
        (prior[0, 0], prior[0, 1], prior[1, 1]),
    )


@compiled
def _without_prior(x: Array, P: Array, prior: Array) -> tuple[Array, Array]:
    """Return an estimate as the records alone tell it, and the covariance of what a sound motor shows then.

    These are P0 (P0 - P)^-1 x and P0 + N = P0 (P0 - P)^-1 P0, for P = P0 (P0 + N)^-1 N.
    """
    without = prior @ _inverse(prior - P)
    return without @ x, without @ prior


@compiled
def _inverse(matrix: Array) -> Array:
    a, b, c, d = matrix[0, 0], matrix[0, 1], matrix[1, 0], matrix[1, 1]
    determinant = a * d - b * c
    out = np.empty((2, 2))
    out[0, 0], out[0, 1] = d / determinant, -b / determinant
    out[1, 0], out[1, 1] = -c / determinant, a / determinant
    return out


@compiled
def _likeliest(asymmetry: Array, covariance: Array, directions: Array) -> tuple[int, float, float, float]:
    """Return the direction that explains an asymmetry best, with size, deviation and score."""
    W = _inverse(covariance)
    best, size, deviation, score = 0, 0.0, 0.0, -1e300
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
    W = _inverse(covariance)
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
