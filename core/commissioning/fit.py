"""Least squares over any of the coordinates, for any number of records together.

The Jacobian comes from central differences, all of a record's in one batch of the compiled kernel.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.commissioning.errors import DivergenceError
from core.commissioning.prior import Prior
from core.commissioning.start import Start
from core.commissioning.unknowns import Coordinates
from core.machines.base import Array
from core.machines.candidates import LoadLaw

STEP = 1e-3
"""Step of the difference quotients; every coordinate is of order one. The stepping's reference speed, which
changes in jumps, moves a current by 1e-6."""
CONVERGED = 1e-9
"""Relative gain of a step at which the iteration ends."""
COARSELY = 1e-6
"""The same of fits whose result is refined again."""
MOST_STEPS = 60
FIRST_DAMPING, LEAST_DAMPING, LAST_DAMPING = 1e-2, 1e-9, 1e5
DAMPINGS = np.array([1e-2, 1e-1, 1.0, 1e1, 1e2])
"""Tried at once, over the last step's."""
Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Fit:
    """Coordinates at their best.

    Parameters
    ----------
    vector : ndarray, shape (entries,)
        Coordinates.
    free : ndarray of bool, shape (entries,)
        Which coordinates are fitted.
    residuals : tuple of ndarray
        Measured minus modelled winding current of each record, shape (2, compared) [A].
    jacobians : tuple of ndarray
        Derivatives of the modelled current after all coordinates, of each record, shape (entries, 2,
        compared); zero where a record does not depend on one.
    evaluations : int
        Number of simulated candidates or evaluated points.
    """

    vector: Array
    free: Mask
    residuals: tuple[Array, ...]
    jacobians: tuple[Array, ...]
    evaluations: int

    @property
    def squared_error(self) -> float:
        """Sum of all squared residuals [A^2]."""
        return _squared(self.residuals)


class Records:
    """Starts of one motor under one load law: what a point in the coordinates makes of their currents.

    Parameters
    ----------
    starts : sequence of Start
        The starts.
    prior : Prior
        What is expected of the motor before a record is seen.
    load_law : LoadLaw
        How the load torque grows with speed.
    changes : bool, default False
        Whether the motor changes from a start to running: deep bars, leakage that saturates.
    load_changes : bool, default False
        Whether the load changes during the starts.
    """

    def __init__(
        self,
        starts: Sequence[Start],
        prior: Prior,
        load_law: LoadLaw,
        *,
        changes: bool = False,
        load_changes: bool = False,
    ) -> None:
        self.starts = tuple(starts)
        self.load_law = load_law
        self.coordinates = Coordinates(prior, self.starts, changes, load_changes)
        self._playbacks = [start.playback(load_law, varies=changes or load_changes) for start in starts]
        self.evaluations = 0

    def squared_errors(self, vectors: Array) -> Array:
        """Sum the squared residuals of a batch over all records.

        Parameters
        ----------
        vectors : ndarray, shape (candidates, entries)
            Coordinates of each candidate.

        Returns
        -------
        ndarray, shape (candidates,)
            Sums [A^2].
        """
        self.evaluations += len(vectors) * len(self.starts)
        total = np.zeros(len(vectors))
        for k, (start, playback) in enumerate(zip(self.starts, self._playbacks, strict=True)):
            total += playback.squared_error(self.coordinates.candidates(vectors, k), start.measured_ab)
        return total

    def linearise(self, vector: Array, free: Mask) -> tuple[list[Array], list[Array]]:
        """Return the residuals of each record and the derivatives of its modelled current.

        Derivatives are zero after coordinates that are not free. Where the inertia is small beside a load
        that grows with the square of the speed, the stepped current can grow without bound.

        Parameters
        ----------
        vector : ndarray, shape (entries,)
            Coordinates.
        free : ndarray of bool, shape (entries,)
            Which coordinates are fitted.

        Returns
        -------
        residuals : list of ndarray
            Measured minus modelled current, shape (2, compared) [A].
        jacobians : list of ndarray
            Derivatives, shape (entries, 2, compared).

        Raises
        ------
        DivergenceError
            If a current is not finite at this point or right beside it.
        """
        lower, upper = self.coordinates.bounds()
        residuals, jacobians = [], []
        for k, start in enumerate(self.starts):
            entries = [entry for entry in self.coordinates.of_record(k) if free[entry]]
            rows = np.tile(vector, (1 + 2 * len(entries), 1))
            for n, entry in enumerate(entries):
                rows[1 + 2 * n, entry] = min(vector[entry] + STEP, upper[entry])
                rows[2 + 2 * n, entry] = max(vector[entry] - STEP, lower[entry])
            current = self.currents(rows, k)
            if not np.isfinite(current).all():
                raise DivergenceError(", ".join(one.source for one in self.starts))
            steps = np.array([rows[1 + 2 * n, e] - rows[2 + 2 * n, e] for n, e in enumerate(entries)])
            jacobian = np.zeros((vector.size, *start.measured_ab.shape))
            jacobian[entries] = (current[1::2] - current[2::2]) / steps[:, np.newaxis, np.newaxis]
            residuals.append(start.measured_ab - current[0])
            jacobians.append(jacobian)
        return residuals, jacobians

    def fit(self, start: Array, free: Mask, *, converged: float = CONVERGED) -> Fit:
        """Minimise the squared residuals from one vector over the free coordinates, the others held.

        The algorithm is Levenberg's and Marquardt's with several dampings tried in one batch. It works on the
        normal equations: the decomposition of a whole record's Jacobian takes several times as long as
        simulating it, and the damping keeps what the record does not tell from growing.
        scipy.optimize.least_squares ends at the same residuals and takes about three times as long
        (`python -m benchmarks.refinement`).

        Parameters
        ----------
        start : ndarray, shape (entries,)
            Vector to begin at.
        free : ndarray of bool, shape (entries,)
            Which coordinates are fitted.
        converged : float, optional
            Relative gain of a step at which the iteration ends.

        Returns
        -------
        Fit
            The fit.

        Raises
        ------
        DivergenceError
            If the current is not finite where the fit begins, or beside a point that it comes to.
        """
        lower, upper = self.coordinates.bounds()
        begun = self.evaluations
        vector, damping = np.clip(start, lower, upper), FIRST_DAMPING
        residuals, jacobians = self.linearise(vector, free)
        error = _squared(residuals)
        for _ in range(MOST_STEPS):
            gradient = sum((np.einsum("iak,ak->i", j, r) for j, r in zip(jacobians, residuals, strict=True)))
            outwards = ((vector <= lower) & (gradient < 0.0)) | ((vector >= upper) & (gradient > 0.0))
            moving = np.flatnonzero(free & ~outwards)
            if not moving.size:
                break
            curvature = sum(_products(jacobian[moving]) for jacobian in jacobians)
            dampings = damping * DAMPINGS
            trials = np.tile(vector, (dampings.size, 1))
            for trial, one in zip(trials, dampings, strict=True):
                damped = curvature + np.diag(one * np.diag(curvature) + 1e-300)
                trial[moving] += np.linalg.lstsq(damped, gradient[moving])[0]
            trials = np.clip(trials, lower, upper)
            errors = self.squared_errors(trials)
            best = int(np.argmin(errors))
            if not errors[best] < error:
                if damping >= LAST_DAMPING:
                    break
                damping *= 1e3
                continue
            gain, error = error - float(errors[best]), float(errors[best])
            vector, damping = trials[best], max(float(dampings[best]) * 0.1, LEAST_DAMPING)
            residuals, jacobians = self.linearise(vector, free)
            if gain <= converged * error:
                break
        residuals, jacobians = self.linearise(vector, np.ones_like(free))
        return Fit(vector, free, tuple(residuals), tuple(jacobians), self.evaluations - begun)

    def currents(self, vectors: Array, record: int) -> Array:
        """Return the modelled currents of one record.

        Parameters
        ----------
        vectors : ndarray, shape (candidates, entries)
            Coordinates of each candidate.
        record : int
            Number of the record, from 0.

        Returns
        -------
        ndarray, shape (candidates, 2, compared)
            Winding currents on Clarke axes [A].
        """
        self.evaluations += len(vectors)
        return self._playbacks[record].trajectories(self.coordinates.candidates(vectors, record)).current


def every(vector: Array) -> Mask:
    """Return that all coordinates of a vector are fitted.

    Parameters
    ----------
    vector : ndarray, shape (entries,)
        The vector.

    Returns
    -------
    ndarray of bool, shape (entries,)
        True everywhere.
    """
    return np.ones(vector.size, dtype=np.bool_)


def _products(jacobian: Array) -> Array:
    """Inner products of derivatives (entries, 2, compared): (entries, entries)."""
    flat = jacobian.reshape(len(jacobian), -1)
    return np.asarray(flat @ flat.T)


def _squared(residuals: Sequence[Array]) -> float:
    return float(sum((residual**2).sum() for residual in residuals))
