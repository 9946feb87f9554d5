"""Whether a motor's standing asymmetry is more than its sensors and a sound winding leave."""

from dataclasses import dataclass
from functools import lru_cache
from math import sqrt
from typing import Final

import numpy as np

from core.condition.signatures import PATHS, shorted_turns
from core.machines.base import Array
from core.machines.parameters import Motor

STANDING_SCORE: Final = 3.7
"""Standard deviations beyond which a standing asymmetry is no sound motor's: one motor in a thousand."""


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
    """

    level: float
    deviation: float
    winding: int
    path_ratio: float
    score: float
    from_bus: bool


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
    weight = np.linalg.inv(covariance)
    directions = _directions(motor)
    along = directions @ (weight @ asymmetry)
    information = np.einsum("ni,ij,nj->n", directions, weight, directions)
    score = along / np.sqrt(information)
    best = int(np.argmax(score))
    return Standing(
        level=float(along[best] / information[best]),
        deviation=1.0 / sqrt(float(information[best])),
        winding=best // len(PATHS),
        path_ratio=PATHS[best % len(PATHS)],
        score=float(score[best]),
        from_bus=from_bus,
    )


def without_prior(estimate: Array, covariance: Array, prior: Array) -> tuple[Array, Array]:
    """Take the prior out of an estimate.

    Parameters
    ----------
    estimate, covariance : ndarray, shapes (2,), (2, 2)
        What the filter says.
    prior : ndarray, shape (2, 2)
        Covariance that it started from, about zero.

    Returns
    -------
    estimate, covariance : ndarray, shapes (2,), (2, 2)
        What the records alone say: Lam0^-1 d0 and Lam0^-1 with Lam0 = P0^-1 - P0^-1 P P0^-1, which is the
        covariance of what a sound motor shows, the prior's spread included.
    """
    inverse = np.linalg.inv(prior)
    spread = np.linalg.inv(inverse - inverse @ covariance @ inverse)
    return np.asarray(spread @ (inverse @ estimate)), np.asarray(spread)


@lru_cache(maxsize=256)
def _directions(motor: Motor) -> Array:
    """Return what shorted turns add to E, shape (windings x paths, 2)."""
    found = [shorted_turns(motor, winding, p) for winding in range(3) for p in PATHS]
    return np.array([[u.real, u.imag] for u in found])
