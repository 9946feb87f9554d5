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

from dataclasses import replace
from functools import cached_property
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from core.diagnosis.case import Case
from core.diagnosis.operating_point import from_phasors
from core.diagnosis.path_fits import HIGHEST, LOWEST, UNKNOWNS, FittedPaths, PathFits, candidates_of
from core.diagnosis.propagation import Known, errors_of
from core.diagnosis.refinement import FAULT_LEVEL, LOAD_LEVEL, PATH_RATIO, TIME_OFFSET, Fit, Refinement
from core.machines.base import Array

DEAD_SHORTED = 0.5
"""Probability of dead-shorted turns before the record is seen."""
PATH_SHARES = np.linspace(0.0, 0.9, 19)
"""Shares u of the loop's resistance that lie in the path. At the last, nine times the turns' own resistance,
the current is in phase with the voltage, as in other asymmetries."""
COARSE_SHARES = np.array([0.0, 0.5])
"""Shares with which the windings are told apart: their directions differ by more than any path turns them."""
FIRST_LEVEL, LEAST_START, LEAST_LOAD, MOST_LOAD = 0.03, 0.002, 0.02, 1.5
NEAR, NEGLIGIBLE = 0.1, 3e-3
"""Steps in standard deviations below which a fit is good enough to be weighed, and to be used."""
POINTS = 40
"""Points with which a hypothesis stands for its normal distribution in a mixture."""
WITHIN_REACH = 4.0
"""Misfit above the least, two standard deviations, up to which a point belongs to a hypothesis."""
TAIL = 0.025
MOST_MISFIT = 9.2
"""Least misfit that one record of a hundred exceeds: quantile of chi square, two degrees of freedom."""

_NORMAL_POINTS = np.array([NormalDist().inv_cdf((k + 0.5) / POINTS) for k in range(POINTS)])


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
        self._fits = PathFits(refinement, self._covariance)

    @property
    def evaluations(self) -> int:
        """Number of evaluations of the model so far."""
        return self._fits.evaluations

    @property
    def backward_A(self) -> float:
        """Standard deviation of the backward-turning current by noise, sensors and parameters [A, peak]."""
        return float(np.sqrt(self._covariance[2, 2] + self._covariance[3, 3]))

    @cached_property
    def _windings(self) -> FittedPaths:
        """COARSE_SHARES of each winding."""
        windings, shares = np.repeat(np.arange(3), COARSE_SHARES.size), np.tile(COARSE_SHARES, 3)
        start = np.tile([FIRST_LEVEL, self._load, 0.0], (windings.size, 1))
        return self._fits.fit(windings, shares, start, NEAR)

    @cached_property
    def winding(self) -> int:
        """The likeliest winding."""
        evidence = self._windings.log_evidence.reshape(3, -1)
        return int(np.argmax(np.logaddexp.reduce(evidence, axis=1)))

    @cached_property
    def _paths(self) -> FittedPaths:
        """Every path of the likeliest winding, dead-shorted turns first."""
        dead, bridged = self._windings.values[self._windings.winding == self.winding]
        way = np.minimum(PATH_SHARES / COARSE_SHARES[1], 1.0)[:, np.newaxis]
        start = dead + way * (bridged - dead)
        start[:, 0] = np.maximum(start[:, 0], LEAST_START)
        return self._fits.fit(np.full(PATH_SHARES.size, self.winding), PATH_SHARES, start, NEAR)

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
        misfit = self._fits.misfit(values, self._fits.modelled(values, fit.candidate.winding, np.zeros(1)))
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
        found = self._fits.fit(np.full(1, self.winding), np.full(1, share), start, NEGLIGIBLE)
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
        modelled = self._fits.modelled(values, fit.candidate.winding, np.zeros(1))
        left = (self._measured - modelled)[0]
        response = {name: one for name, one in fit.response.items() if name != FAULT_LEVEL}
        return replace(
            fit,
            candidate=candidates_of(values, fit.candidate.winding, np.zeros(1)),
            misfit=float(self._fits.misfit(values, modelled)[0]),
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

    def _as_fit(self, found: FittedPaths, errors: dict[str, float], edge: NDArray[np.bool_]) -> Fit:
        at_bound = tuple(name for name, is_edge in zip(UNKNOWNS, edge.tolist(), strict=True) if is_edge)
        candidate = candidates_of(found.values, found.winding, found.share)
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
