"""Fits of windings and paths to the phasors of a record, all at once: level, load and offset of each.

What a path is, and what is known of sensors, parameters, offsets and loads: `core.diagnosis.paths`.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.diagnosis.fundamental import components
from core.diagnosis.priors import beliefs
from core.diagnosis.refinement import FAULT_LEVEL, LOAD_LEVEL, TIME_OFFSET, Refinement
from core.machines.base import Array
from core.machines.candidates import Candidates

UNKNOWNS = (FAULT_LEVEL, LOAD_LEVEL, TIME_OFFSET)
STEPS = np.array([1e-5, 1e-4, 1e-7])
"""Steps of the difference quotients, small against any curvature and large against rounding."""
LOWEST, HIGHEST = np.array([0.0, -0.2, -8e-3]), np.array([0.5, 2.0, 8e-3])
WIDEST = np.diag((HIGHEST - LOWEST) ** -2.0)
"""Curvature of a prior as wide as the ranges: none is wider, even where the record says nothing."""
LONGEST_STEP = np.array([0.2, 0.4, 1e-3])
MOST_ROUNDS, ROUNDS_OF_ALL = 12, 3
HOPELESS = 40.0
"""Promised misfit above the least beyond which a fit is not followed further after ROUNDS_OF_ALL."""
FIRST_DAMPING = 0.1


@dataclass(frozen=True, slots=True)
class FittedPaths:
    """Fits of a batch: windings and path shares held, level, load and offset at their likeliest.

    Parameters
    ----------
    winding : ndarray of int, shape (candidates,)
        Winding with the fault.
    share : ndarray, shape (candidates,)
        Share of the loop's resistance that lies in the path.
    values, scatter : ndarray, shape (candidates, 3)
        Level, load and offset, and the standard deviations that noise alone gives them.
    misfit, log_evidence : ndarray, shape (candidates,)
        Least misfit, and the logarithm of the evidence but for a constant.
    response : ndarray, shape (candidates, 3, 4)
        Change of level, load and offset by one ampere more of each measured component.
    left : ndarray of complex, shape (candidates,)
        Backward-turning current left, peak [A].
    converged : ndarray of bool, shape (candidates,)
        Whether the last step was negligible.
    """

    winding: NDArray[np.int64]
    share: Array
    values: Array
    scatter: Array
    misfit: Array
    log_evidence: Array
    response: Array
    left: NDArray[np.complex128]
    converged: NDArray[np.bool_]


class PathFits:
    """Fits to one record.

    Parameters
    ----------
    refinement : Refinement
        The record's phasors, noise, and the motor on its voltage.
    covariance : ndarray, shape (4, 4)
        Of the measured components, by noise, sensors and parameters [A^2].
    """

    def __init__(self, refinement: Refinement, covariance: Array) -> None:
        self._refinement = refinement
        self._measured = refinement.record.current.components
        self._whitening = np.linalg.inv(np.linalg.cholesky(covariance))
        self.evaluations = 0

    def fit(self, winding: NDArray[np.int64], share: Array, start: Array, precision: float) -> FittedPaths:
        """Fit level, load and offset to every winding and path at once, by Gauss and Newton.

        Steps that do not help are damped, after Levenberg and Marquardt.

        Parameters
        ----------
        winding : ndarray of int, shape (candidates,)
            Winding with the fault.
        share : ndarray, shape (candidates,)
            Share of the loop's resistance that lies in the path.
        start : ndarray, shape (candidates, 3)
            Level, load and offset to start from.
        precision : float
            Step in standard deviations below which a fit is good enough.

        Returns
        -------
        FittedPaths
            The fits.
        """
        # The turns, mu_eq (1 + p), stay well below the whole phase.
        turns = HIGHEST[0] * (1.0 - share)
        highest = np.column_stack([turns, np.tile(HIGHEST[1:], (share.size, 1))])
        values = np.clip(start, LOWEST, highest)
        modelled, slopes = self._linearised(values, winding, share)
        misfit = self.misfit(values, modelled)
        damping = np.zeros(share.size)
        converged, hopeless = np.zeros(share.size, np.bool_), np.zeros(share.size, np.bool_)
        for done in range(MOST_ROUNDS):
            k = np.flatnonzero(~converged & ~hopeless)
            if k.size == 0:
                break
            curvature = np.einsum("nri,nrj->nij", slopes[k], slopes[k]) + WIDEST
            diagonal = np.einsum("nii->ni", curvature)
            downhill = np.einsum("nri,nr->ni", slopes[k], self._rows(values[k], modelled[k]))
            if done >= ROUNDS_OF_ALL:
                whole = np.linalg.solve(curvature, downhill[..., np.newaxis])[..., 0]
                promised = misfit[k] - np.einsum("ni,ni->n", downhill, whole)
                hopeless[k] = promised > misfit.min() + HOPELESS
            damped = curvature + (damping[k, np.newaxis] * diagonal)[:, :, np.newaxis] * np.eye(3)
            step = -np.linalg.solve(damped, downhill[..., np.newaxis])[..., 0]
            moved = np.clip(values[k] + np.clip(step, -LONGEST_STEP, LONGEST_STEP), LOWEST, highest[k])
            near = (np.abs(moved - values[k]) * np.sqrt(diagonal) < precision).all(axis=1)
            converged[k] = near
            k, moved = k[~near], moved[~near]
            if k.size == 0:
                continue
            there, slopes_there = self._linearised(moved, winding[k], share[k])
            fallen = self.misfit(moved, there)
            better = fallen <= misfit[k]
            shorter = np.maximum(FIRST_DAMPING, 4.0 * damping[k])
            longer = np.where(damping[k] > FIRST_DAMPING, damping[k] / 4.0, 0.0)
            damping[k] = np.where(better, longer, shorter)
            taken = k[better]
            values[taken], modelled[taken], slopes[taken], misfit[taken] = (
                moved[better], there[better], slopes_there[better], fallen[better],
            )  # fmt: skip
        curvature = np.einsum("nri,nrj->nij", slopes, slopes) + WIDEST
        weighted = np.einsum("nri,rs->nis", slopes[:, :4], self._whitening)
        response = np.linalg.inv(curvature) @ weighted
        scatter = np.einsum("nir,rs,nis->ni", response, self._refinement.noise, response)
        left = self._measured - modelled
        return FittedPaths(
            winding=winding,
            share=share,
            values=values,
            scatter=np.sqrt(scatter),
            misfit=misfit,
            log_evidence=-0.5 * (misfit + np.linalg.slogdet(curvature)[1]),
            response=response,
            left=left[:, 2] + 1j * left[:, 3],
            converged=converged,
        )

    def _linearised(self, values: Array, winding: NDArray[np.int64], share: Array) -> tuple[Array, Array]:
        """Return modelled components (n, 4) and the slopes of `_rows` (n, 6, 3)."""
        n, unknowns = values.shape
        moves = np.concatenate([np.zeros((1, unknowns)), np.diag(STEPS)])
        around = (values + moves[:, np.newaxis, :]).reshape(-1, unknowns)
        seen = self.modelled(around, np.tile(winding, 1 + unknowns), np.tile(share, 1 + unknowns))
        here, *beside = seen.reshape(1 + unknowns, n, 4)
        known = beliefs(values[:, 2], values[:, 1])
        slopes = np.zeros((n, 6, unknowns))
        slopes[:, :4] = np.einsum("rs,kns->nrk", self._whitening, np.stack(beside) - here) / STEPS
        slopes[:, 4, 2] = known.offset_slope
        slopes[:, 5, 1] = known.load_slope
        return here, slopes

    def _rows(self, values: Array, modelled: Array) -> Array:
        """Modelled minus measured components over their standard deviation, and the priors' rows, (n, 6)."""
        known = beliefs(values[:, 2], values[:, 1])
        whitened = (modelled - self._measured) @ self._whitening.T
        return np.column_stack([whitened, known.offset, known.load])

    def modelled(self, values: Array, winding: NDArray[np.int64], share: Array) -> Array:
        """Return what the model makes of levels, loads and offsets.

        Parameters
        ----------
        values : ndarray, shape (candidates, 3)
            Level, load and offset.
        winding : ndarray of int, shape (candidates,)
            Winding with the fault.
        share : ndarray, shape (candidates,)
            Share of the loop's resistance that lies in the path.

        Returns
        -------
        ndarray, shape (candidates, 4)
            Components of the current's phasors [A, peak].
        """
        self.evaluations += len(values)
        return components(self._refinement.running.state(candidates_of(values, winding, share)).current)

    def misfit(self, values: Array, modelled: Array) -> Array:
        """Return how far modelled currents are from the measured ones, with the priors of load and offset.

        Parameters
        ----------
        values : ndarray, shape (candidates, 3)
            Level, load and offset.
        modelled : ndarray, shape (candidates, 4)
            What the model makes of them [A, peak].

        Returns
        -------
        ndarray, shape (candidates,)
            The misfit: squares over their variances, summed.
        """
        rows = (modelled - self._measured) @ self._whitening.T
        return np.asarray(np.sum(rows**2, axis=1) + beliefs(values[:, 2], values[:, 1]).misfit)


def candidates_of(values: Array, winding: NDArray[np.int64], share: Array) -> Candidates:
    """Return the candidates of the machine model that windings, paths, levels, loads and offsets make.

    Parameters
    ----------
    values : ndarray, shape (candidates, 3)
        Level, load and offset.
    winding : ndarray of int, shape (candidates,)
        Winding with the fault.
    share : ndarray, shape (candidates,)
        Share of the loop's resistance that lies in the path.

    Returns
    -------
    Candidates
        The candidates.
    """
    return Candidates(
        fault_level=np.ascontiguousarray(values[:, 0]),
        winding=winding,
        load_level=np.ascontiguousarray(values[:, 1]),
        time_offset_s=np.ascontiguousarray(values[:, 2]),
        path_ratio=share / (1.0 - share),
    )
