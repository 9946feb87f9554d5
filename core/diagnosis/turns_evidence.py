"""Evidence for shorted turns: the posterior over phase, axis, leakage and level.

The grid is looked at coarsely with the errors of a healthy machine; then each phase again with those at its
likeliest point, where R_s and X_ls act on the fault's own current; then finely about what that leaves
possible.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import log
from typing import Final

import numpy as np
from numpy.typing import NDArray

from core.diagnosis.coil_likelihood import ShortedTurns, Weighed, weigh_turns
from core.diagnosis.coil_prior import TurnsPrior
from core.diagnosis.record_errors import RecordErrors
from core.diagnosis.running_range import RunningPoint, SlipRange
from core.machines.base import Array

LOWEST_LEVEL, HIGHEST_LEVEL = 5e-4, 0.4
FIRST_LEVELS: Final = 20
MOST_LEVELS: Final = 36
FINEST_RATIO: Final = 1.04
"""Ratio of neighbouring levels at the second look, where it needs no more than MOST_LEVELS."""
POSSIBLE: Final = 25.0
"""Log of the posterior below the greatest up to which a point of the coarse look is looked at finely."""
WORTH_A_LOOK: Final = 1.0
"""Evidence for shorted turns at the first look from which on there is another [nats]."""
SURE_PLACE: Final = 0.65
"""Probability of one axis and leakage from which on the level is that of this place alone."""


@dataclass(frozen=True, slots=True)
class PhasePosterior:
    """Posterior of shorted turns in one phase.

    Parameters
    ----------
    winding : int
        The phase, in the frame of the windings.
    levels : ndarray, shape (levels,)
        Equivalent levels.
    log_posterior : ndarray, shape (axes, leakages, levels)
        Log of likelihood times prior of each point.
    slip, offset_s : ndarray, shape (axes, leakages, levels)
        Likeliest slip, and offset [s].
    """

    winding: int
    levels: Array
    log_posterior: Array
    slip: Array
    offset_s: Array

    @property
    def log_evidence(self) -> float:
        """Log of the evidence for this phase."""
        return float(np.logaddexp.reduce(self.log_posterior, axis=None))

    def likeliest(self, prior: TurnsPrior) -> tuple[ShortedTurns, float, float]:
        """Return the likeliest point of the places of a prior, its slip and its offset [s]."""
        a, p, k = np.unravel_index(int(np.argmax(self.log_posterior)), self.log_posterior.shape)
        turns = ShortedTurns(
            float(self.levels[k]), float(prior.leakage[p]), complex(prior.ahead[a]), self.winding
        )
        return turns, float(self.slip[a, p, k]), float(self.offset_s[a, p, k])


@dataclass(frozen=True)
class TurnsPosterior:
    """Posterior of shorted turns.

    Parameters
    ----------
    prior : TurnsPrior
        Axes and leakages that are weighed.
    phases : tuple of PhasePosterior
        Of each phase, in the frame of the windings.
    """

    prior: TurnsPrior
    phases: tuple[PhasePosterior, ...]

    @cached_property
    def log_evidence(self) -> float:
        """Log of the evidence for shorted turns."""
        return float(np.logaddexp.reduce([one.log_evidence for one in self.phases]))

    @cached_property
    def phase_probability(self) -> Array:
        """Probability of each phase, given shorted turns, shape (3,)."""
        return np.asarray(np.exp([one.log_evidence - self.log_evidence for one in self.phases]))

    @cached_property
    def likeliest_phase(self) -> PhasePosterior:
        """The phase with the most evidence."""
        return max(self.phases, key=lambda one: one.log_evidence)

    @cached_property
    def likeliest(self) -> tuple[ShortedTurns, float, float]:
        """The likeliest point of the likeliest phase, its slip and its offset [s]."""
        return self.likeliest_phase.likeliest(self.prior)

    @cached_property
    def axis_probability(self) -> Array:
        """Probability of each axis, given the likeliest phase, shape (axes,)."""
        phase = self.likeliest_phase
        by_axis = np.logaddexp.reduce(phase.log_posterior, axis=(1, 2))
        return np.asarray(np.exp(by_axis - phase.log_evidence))

    @cached_property
    def is_of_one_place(self) -> bool:
        """Whether one axis and leakage of one phase are much likelier than all others."""
        by_place = np.logaddexp.reduce(self.likeliest_phase.log_posterior, axis=2)
        return bool(by_place.max() - self.log_evidence >= log(SURE_PLACE))

    @cached_property
    def level(self) -> float:
        """Median of the level; of the likeliest place alone where it is much likelier than all others."""
        if not self.is_of_one_place:
            return self.level_quantile(0.5)
        phase = self.likeliest_phase
        by_place = np.logaddexp.reduce(phase.log_posterior, axis=2)
        a, p = np.unravel_index(int(np.argmax(by_place)), by_place.shape)
        weight = np.exp(phase.log_posterior[a, p] - by_place[a, p])
        return float(np.exp(np.interp(0.5, weight.cumsum() - 0.5 * weight, np.log(phase.levels))))

    @cached_property
    def _of_level(self) -> tuple[Array, Array]:
        """Levels in ascending order, and the probability below each."""
        levels = np.concatenate([one.levels for one in self.phases])
        weights = np.concatenate(
            [
                np.exp(np.logaddexp.reduce(one.log_posterior, axis=(0, 1)) - self.log_evidence)
                for one in self.phases
            ]
        )
        order = np.argsort(levels)
        weights = weights[order]
        return levels[order], np.cumsum(weights) - 0.5 * weights

    def nearest_to(self, level: float) -> tuple[ShortedTurns, float, float]:
        """Return the likeliest turns of a level in the likeliest phase, their slip and their offset [s]."""
        phase, prior = self.likeliest_phase, self.prior
        k = int(np.argmin(np.abs(phase.levels - level)))
        a, p = np.unravel_index(int(np.argmax(phase.log_posterior[:, :, k])), phase.slip.shape[:2])
        turns = ShortedTurns(level, float(prior.leakage[p]), complex(prior.ahead[a]), phase.winding)
        return turns, float(phase.slip[a, p, k]), float(phase.offset_s[a, p, k])

    def level_quantile(self, probability: float) -> float:
        """Return the level that is not exceeded with a probability, given shorted turns."""
        levels, below = self._of_level
        return float(np.exp(np.interp(probability, below, np.log(levels))))

    def moments(self, name: str) -> tuple[float, float]:
        """Return mean and variance of the likeliest slips or offsets over the grid, given shorted turns."""
        values, weights = [], []
        for one in self.phases:
            values.append(getattr(one, name).ravel())
            weights.append(np.exp(one.log_posterior - self.log_evidence).ravel())
        value, weight = np.concatenate(values), np.concatenate(weights)
        mean = float(value @ weight)
        return mean, float(weight @ (value - mean) ** 2)


def turns_posterior(
    errors: RecordErrors, prior: TurnsPrior, slips: SlipRange, point: RunningPoint, healthy: float
) -> TurnsPosterior:
    """Weigh shorted turns of a record; `healthy` is the log of the likelihood of a healthy machine."""
    grid, coarse = _Grid(errors, slips, point), prior.coarse
    levels = _levels(LOWEST_LEVEL, HIGHEST_LEVEL, FIRST_LEVELS)
    first = tuple(grid.look(coarse, point.covariance, winding, levels) for winding in range(3))
    found = TurnsPosterior(coarse, first)
    if found.log_evidence < healthy + WORTH_A_LOOK:
        return found
    # The errors follow the point, and the point the errors: twice is enough.
    again = [grid.look(coarse, grid.errors_at(one, coarse), one.winding, levels) for one in first]
    most = max(float(one.log_posterior.max()) for one in again)
    return TurnsPosterior(prior, tuple(grid.look_finely(prior, one, most) for one in again))


class _Grid:
    """Looks at the grid of one record."""

    def __init__(self, errors: RecordErrors, slips: SlipRange, point: RunningPoint) -> None:
        self._errors, self._slips, self._start = errors, slips, (point.slip, point.offset_s)

    def errors_at(self, found: PhasePosterior, prior: TurnsPrior) -> Array:
        """Return the covariance of the errors at the likeliest point of a phase."""
        turns, slip, _ = found.likeliest(prior)
        return self._errors.covariance(turns, slip)

    def look_finely(self, prior: TurnsPrior, found: PhasePosterior, most: float) -> PhasePosterior:
        """Look at what a coarse look leaves possible; of a phase that it excludes, at one place."""
        coarse, logs = prior.coarse, found.log_posterior
        own = float(logs.max())
        least = most - POSSIBLE if own > most - POSSIBLE else own
        at = np.flatnonzero(logs.max(axis=(0, 1)) >= least)
        low, high = found.levels[max(at[0] - 1, 0)], found.levels[min(at[-1] + 1, found.levels.size - 1)]
        count = min(MOST_LEVELS, 2 + int(log(high / low) / log(FINEST_RATIO)))
        possible = (logs.max(axis=2) >= least)[coarse.nearest(prior)]
        levels = _levels(float(low), float(high), count)
        return self.look(prior, self.errors_at(found, coarse), found.winding, levels, possible)

    def look(
        self,
        prior: TurnsPrior,
        covariance: Array,
        winding: int,
        levels: Array,
        possible: NDArray[np.bool_] | None = None,
    ) -> PhasePosterior:
        """Weigh the turns of one phase at every place and level, with the errors of a covariance."""
        errors, shape = self._errors, (prior.ahead.size, prior.leakage.size, levels.size)
        out = Weighed(np.empty(shape), np.empty(shape), np.empty(shape))
        weigh_turns(
            errors.compared(covariance, self._slips),
            errors.machine,
            levels,
            prior.leakage,
            prior.ahead,
            np.ones(shape[:2], np.bool_) if possible is None else possible,
            winding,
            *self._start,
            out,
        )
        step = log(levels[-1] / levels[0]) / (levels.size - 1) / log(HIGHEST_LEVEL / LOWEST_LEVEL)
        known = log(step / 3.0) + prior.log_density(levels) + errors.log_constant(covariance)
        return PhasePosterior(winding, levels, out.log_likelihood + known, out.slip, out.offset_s)


@lru_cache(maxsize=64)
def _levels(low: float, high: float, count: int) -> Array:
    levels = np.geomspace(low, high, count)
    levels.flags.writeable = False
    return levels
