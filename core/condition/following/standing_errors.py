"""A motor's standing errors as its records alone tell them, without what was known before."""

from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from core.condition.bus.differences import BusDifferences, same_transformer
from core.condition.changes.before_change import before_change
from core.condition.complex_parts import inverse
from core.condition.filter.kalman import WANDER_EC
from core.condition.filter.prior import IMPEDANCE
from core.condition.filter.state import BUS, V2, Candidate, FilterState, SideState
from core.condition.following.expectations import Expectations
from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled

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

    def of_another_class(self, more: Array) -> "StandingErrors":
        """Return the same errors, held against sensors of another class.

        Parameters
        ----------
        more : ndarray, shape (2, 2)
            Covariance of E in sound motors with such sensors, less that with those of before.

        Returns
        -------
        StandingErrors
            Errors with another spread and prior.
        """
        added = (float(more[0, 0]), float(more[0, 1]), float(more[1, 1]))
        return replace(
            self,
            spread=[old + new for old, new in zip(self.spread, added, strict=True)],
            prior=[old + new for old, new in zip(self.prior, added, strict=True)],
        )


def standing_errors_of(
    filters: Any, bank: Any, sides: Any, bus: BusDifferences, expectations: Expectations
) -> StandingErrors:
    """Return the standing errors.

    Parameters
    ----------
    filters : array of FilterState, shape (1,)
        The filter.
    bank : array of Candidate
        Candidates.
    sides : array of SideState
        Side channels.
    bus : BusDifferences
        Differences from the bus's other motors.
    expectations : Expectations
        What was known of the motor before its first record.

    Returns
    -------
    StandingErrors
        The errors, and how the voltages differ from the bus's.
    """
    (real, imaginary), spread, prior = _of_records(filters, bank, sides, expectations.voltage)
    mean = bus.mean(same_transformer(expectations.usual_difference, sides["r"][BUS]))
    return StandingErrors(
        real, imaginary, list(spread), list(prior),
        mean.difference.real, mean.difference.imag, mean.others, mean.transformers,
    )  # fmt: skip


@compiled
def _of_records(
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
        Covariance of E in sound motors. The filter started from another where the class was edited since.

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
    prior = state.P0[:2, :2].copy()
    edited = voltage - prior
    for i in range(2):
        prior[i, i] += WANDER_VARIANCE * state.records
    found, spread = _without_prior(x[:2].copy(), P[:2, :2].copy(), prior)
    square = state.w.real**2 + state.w.imag**2
    share = VARIES**2 * square / (VARIES**2 * square + WANDERS_OVER * sides[V2].q)
    spread += share**2 * square * np.eye(2)

    # E where the error of Z2 is zero, and how it depends on that.
    slope = P[:2, 4:6].copy() @ inverse(P[4:6, 4:6])
    known = P[:2, :2] - slope @ P[4:6, :2].copy()
    usual, usual_spread = _without_prior(x[:2] - slope @ x[4:6], known, prior)
    slope, _ = _without_prior(slope, known, prior)
    usual_spread += max(IMPEDANCE**2, state.P0[4, 4]) * slope @ slope.T
    if np.trace(usual_spread) < np.trace(spread):
        found, spread = usual, usual_spread
    prior += edited
    spread += edited
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
    without = prior @ inverse(prior - P)
    return without @ x, without @ prior
