"""Which winding, and through what path its turns are bridged: the posterior over both.

Dead-shorted turns draw a current that lags the voltage by the angle of R_s + j X_ls; a path of resistance
turns it towards the voltage. With level, load and offset free besides, four unknowns meet four real figures,
and dead shorts with a long offset and too small a load fit a path as well as the path itself. So every path
is fitted with what is known of offsets and loads (`core.diagnosis.priors`) and of sensors and parameters
(`core.diagnosis.propagation`), and weighed by its evidence (Laplace's approximation of the integral over
level, load and offset):

    ln P(p | y) = ln P(p) - Q_p / 2 - ln det(H_p) / 2,    Q_p = min (r' inv(C) r + priors)

r is what of the currents' phasors is left, C its covariance by noise, sensors and parameters, H_p half the
curvature of Q_p. P gives half to dead-shorted turns and half to paths, evenly over the share u = p / (1 + p)
of the loop's resistance that lies in the path.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from core.diagnosis.case import Case
from core.diagnosis.fundamental import components
from core.diagnosis.operating_point import from_phasors
from core.diagnosis.priors import beliefs
from core.diagnosis.propagation import Known, errors_of
from core.diagnosis.refinement import FAULT_LEVEL, LOAD_LEVEL, PATH_RATIO, TIME_OFFSET, Fit, Refinement
from core.machines.base import Array
from core.machines.candidates import Candidates

DEAD_SHORTED = 0.5
"""Probability of dead-shorted turns before the record is seen."""
PATH_SHARES = np.linspace(0.0, 0.9, 19)
"""Shares u of the loop's resistance that lie in the path. At the last, nine times the turns' own resistance,
the current is in phase with the voltage, as in other asymmetries."""
COARSE_SHARES = np.array([0.0, 0.5])
"""Shares with which the windings are told apart: their directions differ by more than any path turns them."""
UNKNOWNS = (FAULT_LEVEL, LOAD_LEVEL, TIME_OFFSET)
STEPS = np.array([1e-5, 1e-4, 1e-7])
"""Steps of the difference quotients, small against any curvature and large against rounding."""
LOWEST, HIGHEST = np.array([0.0, -0.2, -8e-3]), np.array([0.5, 2.0, 8e-3])
WIDEST = np.diag((HIGHEST - LOWEST) ** -2.0)
"""Curvature of a prior as wide as the ranges: none is wider, even where the record says nothing."""
LONGEST_STEP = np.array([0.2, 0.4, 1e-3])
FIRST_LEVEL, LEAST_START, LEAST_LOAD, MOST_LOAD = 0.03, 0.002, 0.02, 1.5
MOST_ROUNDS, ROUNDS_OF_ALL = 12, 3
HOPELESS = 40.0
"""Promised misfit above the least beyond which a fit is not followed further after ROUNDS_OF_ALL."""
NEAR, NEGLIGIBLE = 0.1, 3e-3
"""Steps in standard deviations below which a fit is good enough to be weighed, and to be used."""
FIRST_DAMPING = 0.1
POINTS = 40
"""Points with which a hypothesis stands for its normal distribution in a mixture."""
WITHIN_REACH = 4.0
"""Misfit above the least, two standard deviations, up to which a point belongs to a hypothesis."""
TAIL = 0.025
MOST_MISFIT = 9.2
"""Least misfit that one record of a hundred exceeds: quantile of chi square, two degrees of freedom."""

_NORMAL_POINTS = np.array([NormalDist().inv_cdf((k + 0.5) / POINTS) for k in range(POINTS)])


@dataclass(frozen=True, slots=True)
class Hypotheses:
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


class PathPosterior:
    """Posterior of one record over windings and paths.

    Parameters
    ----------
    case : Case
        The record in the winding frame.
    refinement : Refinement
        The record's phasors, noise, and the motor on its voltage.
    known : Known
        What a baseline has taken off of the sensors' and the parameters' errors.
    """

    def __init__(self, case: Case, refinement: Refinement, known: Known) -> None:
        self._refinement = refinement
        self._measured = refinement.record.current.components
        near = from_phasors(refinement.record, case.motor, 0)
        self._load = float(np.clip(near.load_level[0], LEAST_LOAD, MOST_LOAD))
        near = replace(near, load_level=np.full(1, self._load))
        errors = errors_of(case, refinement.running.model, refinement.record, near, known)
        self._covariance = refinement.noise + errors @ errors.T
        self._whitening = np.linalg.inv(np.linalg.cholesky(self._covariance))
        self.evaluations = 0

    @property
    def backward_A(self) -> float:
        """Standard deviation of the backward-turning current by noise, sensors and parameters [A, peak]."""
        return float(np.sqrt(self._covariance[2, 2] + self._covariance[3, 3]))

    @cached_property
    def _windings(self) -> Hypotheses:
        """COARSE_SHARES of each winding."""
        windings, shares = np.repeat(np.arange(3), COARSE_SHARES.size), np.tile(COARSE_SHARES, 3)
        start = np.tile([FIRST_LEVEL, self._load, 0.0], (windings.size, 1))
        return self._fitted(windings, shares, start, NEAR)

    @cached_property
    def winding(self) -> int:
        """The likeliest winding."""
        evidence = self._windings.log_evidence.reshape(3, -1)
        return int(np.argmax(np.logaddexp.reduce(evidence, axis=1)))

    @cached_property
    def _paths(self) -> Hypotheses:
        """Every path of the likeliest winding, dead-shorted turns first."""
        dead, bridged = self._windings.values[self._windings.winding == self.winding]
        way = np.minimum(PATH_SHARES / COARSE_SHARES[1], 1.0)[:, np.newaxis]
        start = dead + way * (bridged - dead)
        start[:, 0] = np.maximum(start[:, 0], LEAST_START)
        return self._fitted(np.full(PATH_SHARES.size, self.winding), PATH_SHARES, start, NEAR)

    @cached_property
    def probability(self) -> Array:
        """Posterior probability of each of PATH_SHARES."""
        prior = np.full(PATH_SHARES.size, (1.0 - DEAD_SHORTED) / (PATH_SHARES.size - 1))
        prior[0] = DEAD_SHORTED
        logarithm = self._paths.log_evidence + np.log(prior)
        weight = np.exp(logarithm - logarithm.max())
        return np.asarray(weight / weight.sum())

    @property
    def levels(self) -> Array:
        """Likeliest level of each of PATH_SHARES."""
        return self._paths.values[:, UNKNOWNS.index(FAULT_LEVEL)]

    def interval(self, name: str) -> tuple[float, float]:
        """Return the 95 % interval of an unknown over all paths, each with its own noise.

        Parameters
        ----------
        name : str
            FAULT_LEVEL, LOAD_LEVEL or TIME_OFFSET.

        Returns
        -------
        tuple of float
            Lower and upper end.
        """
        return self.quantile(name, TAIL), self.quantile(name, 1.0 - TAIL)

    def quantile(self, name: str, probability: float) -> float:
        """Return the value of an unknown that is not exceeded with a probability, over all paths.

        Parameters
        ----------
        name : str
            FAULT_LEVEL, LOAD_LEVEL or TIME_OFFSET.
        probability : float
            Between 0 and 1.

        Returns
        -------
        float
            The value.
        """
        k = UNKNOWNS.index(name)
        points = self._paths.values[:, k, np.newaxis] + self._paths.scatter[:, k, np.newaxis] * _NORMAL_POINTS
        weights = np.repeat(self.probability / POINTS, POINTS)
        order = np.argsort(points, axis=None)
        below = np.cumsum(weights[order])
        at = min(int(np.searchsorted(below, probability)), order.size - 1)
        return float(points.ravel()[order[at]])

    def holds(self, fit: Fit) -> bool:
        """Return whether a fit of dead-shorted turns is what the posterior finds likeliest.

        Parameters
        ----------
        fit : Fit
            The fit.

        Returns
        -------
        bool
            True where dead-shorted turns of the same winding are as likely as all paths together and the fit
            is within their reach.
        """
        if int(fit.candidate.winding[0]) != self.winding or self.probability[0] < DEAD_SHORTED:
            return False
        values = np.array([[fit.value(name) for name in UNKNOWNS]])
        misfit = self._misfit(values, self._modelled(values, fit.candidate.winding, np.zeros(1)))
        return bool(fit.is_sound and misfit[0] <= self._paths.misfit[0] + WITHIN_REACH)

    def likeliest(self) -> Fit:
        """Return the fit of dead-shorted turns, or of the likeliest path where paths are likelier.

        Returns
        -------
        Fit
            The fit; its standard errors are what noise gives at this path, the path's own is the posterior's.
        """
        share = self._likeliest_share()
        start = self._paths.values[[int(np.argmin(np.abs(PATH_SHARES - share)))]]
        found = self._fitted(np.full(1, self.winding), np.full(1, share), start, NEGLIGIBLE)
        errors = dict(zip(UNKNOWNS, found.scatter[0].tolist(), strict=True))
        if share > 0.0:
            ratios = PATH_SHARES / (1.0 - PATH_SHARES)
            mean = float(self.probability @ ratios)
            errors[PATH_RATIO] = float(np.sqrt(self.probability @ (ratios - mean) ** 2))
        edge = (found.values[0] <= LOWEST) | (found.values[0] >= HIGHEST)
        return self._as_fit(found, errors, edge)

    def without_fault(self, fit: Fit) -> Fit:
        """Return the healthy machine at the load and the offset of a fit.

        Parameters
        ----------
        fit : Fit
            The fit.

        Returns
        -------
        Fit
            The same without shorted turns.
        """
        values = np.array([[0.0, fit.value(LOAD_LEVEL), fit.value(TIME_OFFSET)]])
        modelled = self._modelled(values, fit.candidate.winding, np.zeros(1))
        left = (self._measured - modelled)[0]
        response = {name: one for name, one in fit.response.items() if name != FAULT_LEVEL}
        return replace(
            fit,
            candidate=_candidates(values, fit.candidate.winding, np.zeros(1)),
            misfit=float(self._misfit(values, modelled)[0]),
            left=complex(left[2], left[3]),
            standard_error={
                name: fit.standard_error[name] for name in UNKNOWNS[1:] if name in fit.standard_error
            },
            response=response,
        )

    @property
    def explains(self) -> bool:
        """Whether some path leaves no more than sensors and parameters make up.

        A path at the end of those tried does not count: it is no other than an asymmetry of another kind.
        """
        best = int(np.argmax(self.probability))
        return bool(best < PATH_SHARES.size - 1 and self._paths.misfit[best] <= MOST_MISFIT)

    def _likeliest_share(self) -> float:
        """Return the share with the greatest posterior, between those tried by a parabola."""
        if self.probability[0] >= DEAD_SHORTED:
            return 0.0
        best = 1 + int(np.argmax(self.probability[1:]))
        if best in {1, PATH_SHARES.size - 1}:
            return float(PATH_SHARES[best])
        before, here, after = self._paths.log_evidence[best - 1 : best + 2].tolist()
        bend = before - 2.0 * here + after
        ahead = 0.5 * (before - after) / bend if bend < 0.0 else 0.0
        return float(PATH_SHARES[best] + ahead * (PATH_SHARES[1] - PATH_SHARES[0]))

    def _as_fit(self, found: Hypotheses, errors: dict[str, float], edge: NDArray[np.bool_]) -> Fit:
        at_bound = tuple(name for name, is_edge in zip(UNKNOWNS, edge.tolist(), strict=True) if is_edge)
        candidate = _candidates(found.values, found.winding, found.share)
        balanced = self._refinement.running.state(candidate).balanced
        return Fit(
            candidate=candidate,
            misfit=float(found.misfit[0]),
            left=complex(found.left[0]),
            is_sound=bool(found.converged[0] and balanced[0]),
            standard_error={name: error for name, error in errors.items() if name not in at_bound},
            degrees_of_freedom=self._refinement.record.cycles - 1,
            at_bound=at_bound,
            evaluations=0,
            response={
                name: one
                for name, one in zip(UNKNOWNS, found.response[0], strict=True)
                if name not in at_bound
            },
        )

    def _fitted(self, winding: NDArray[np.int64], share: Array, start: Array, precision: float) -> Hypotheses:
        """Fit level, load and offset to every winding and path at once, by Gauss and Newton.

        Steps that do not help are damped, after Levenberg and Marquardt.
        """
        # The turns, mu_eq (1 + p), stay well below the whole phase.
        turns = HIGHEST[0] * (1.0 - share)
        highest = np.column_stack([turns, np.tile(HIGHEST[1:], (share.size, 1))])
        values = np.clip(start, LOWEST, highest)
        modelled, slopes = self._linearised(values, winding, share)
        misfit = self._misfit(values, modelled)
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
            fallen = self._misfit(moved, there)
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
        return Hypotheses(
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
        seen = self._modelled(around, np.tile(winding, 1 + unknowns), np.tile(share, 1 + unknowns))
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

    def _modelled(self, values: Array, winding: NDArray[np.int64], share: Array) -> Array:
        self.evaluations += len(values)
        return components(self._refinement.running.state(_candidates(values, winding, share)).current)

    def _misfit(self, values: Array, modelled: Array) -> Array:
        rows = (modelled - self._measured) @ self._whitening.T
        return np.asarray(np.sum(rows**2, axis=1) + beliefs(values[:, 2], values[:, 1]).misfit)


def _candidates(values: Array, winding: NDArray[np.int64], share: Array) -> Candidates:
    return Candidates(
        fault_level=np.ascontiguousarray(values[:, 0]),
        winding=winding,
        load_level=np.ascontiguousarray(values[:, 1]),
        time_offset_s=np.ascontiguousarray(values[:, 2]),
        path_ratio=share / (1.0 - share),
    )
