"""Evidence over all hypotheses of a record's stator, and the posterior that the verdict follows from."""

from dataclasses import dataclass
from functools import cached_property
from math import exp
from typing import Final

import numpy as np

from core.diagnosis.causes import Cause, log_prior_odds
from core.diagnosis.coil_likelihood import fit
from core.diagnosis.coil_prior import turns_prior
from core.diagnosis.other_evidence import OtherCauses, Weighed
from core.diagnosis.record_errors import HEALTHY, Known, RecordErrors
from core.diagnosis.record_figures import RecordFigures
from core.diagnosis.running_range import HealthyFit, RunningPoint, SlipRange, slip_range
from core.diagnosis.turns_evidence import TurnsPosterior, turns_posterior
from core.machines.base import Array
from core.machines.model_names import Model
from core.machines.parameters import Motor

CALLED: Final = 0.92
"""Probability from which on an explanation is the answer."""
ANY_ASYMMETRY: Final = 0.2
"""Asymmetry that tells nothing of slip and offset, a share of V1."""
STARTS: Final = ((0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (0.5, 1e-3), (0.5, -1e-3), (0.5, 4e-3), (0.5, -4e-3))
"""Rated slips and offsets [s] from which the healthy machine is sought."""


@dataclass(frozen=True)
class StatorEvidence:
    """What a record shows of its stator.

    Parameters
    ----------
    errors : RecordErrors
        The record and its errors.
    slips : SlipRange
        Slips that were searched.
    point : RunningPoint
        Slip and offset of the record, whatever its asymmetry.
    healthy : HealthyFit
        The healthy machine that comes nearest.
    turns : TurnsPosterior
        Posterior of shorted turns.
    others : dict of Cause to Weighed
        Evidence of all other causes.
    """

    errors: RecordErrors
    slips: SlipRange
    point: RunningPoint
    healthy: HealthyFit
    turns: TurnsPosterior
    others: dict[Cause, Weighed]
    causes: OtherCauses

    @cached_property
    def log_likelihood_ratio(self) -> dict[Cause, float]:
        """Log of the likelihood of each cause over that of a healthy machine."""
        sound = self.healthy.log_likelihood
        ratios = {cause: one.log_evidence - sound for cause, one in self.others.items()}
        return {Cause.HEALTHY: 0.0} | ratios | {Cause.SHORTED_TURNS: self.turns.log_evidence - sound}

    @property
    def slip(self) -> float:
        """Slip of the likeliest explanation."""
        if self.answer is Cause.SHORTED_TURNS:
            return self.turns.likeliest[1]
        return self.healthy.slip if self.answer is Cause.HEALTHY else self.point.slip

    @property
    def evaluations(self) -> int:
        """Number of hypotheses that were weighed."""
        return sum(one.log_posterior.size for one in self.turns.phases) + len(self.others) + 1

    @property
    def answer(self) -> Cause:
        """The likeliest explanation."""
        return max(self.probability, key=self.probability.__getitem__)

    @cached_property
    def losses(self) -> dict[Cause, Array]:
        """Inverse covariance of the figures with each cause but shorted turns."""
        sound = {Cause.HEALTHY: np.asarray(np.linalg.inv(self.point.covariance))}
        return sound | {cause: one.loss for cause, one in self.others.items()}

    @cached_property
    def probability(self) -> dict[Cause, float]:
        """Probability of each cause; they exclude one another."""
        logs = {cause: log_prior_odds(cause) + one for cause, one in self.log_likelihood_ratio.items()}
        total = float(np.logaddexp.reduce(list(logs.values())))
        return {cause: exp(one - total) for cause, one in logs.items()}


def weigh_stator(
    figures: RecordFigures, motor: Motor, known: Known | None = None, model: str = Model.COIL
) -> StatorEvidence:
    """Weigh all hypotheses of a record's stator."""
    errors = RecordErrors(figures, motor, known, model)
    slips = slip_range(errors.machine, motor.nameplate, figures.angular_frequency)
    point, healthy = _running(errors, slips)
    prior = turns_prior(motor, figures.sequence, model)
    causes = OtherCauses(errors, point, slips)
    turns = turns_posterior(errors, prior, slips, point, healthy.log_likelihood)
    return StatorEvidence(errors, slips, point, healthy, turns, causes.weigh(), causes)


def _running(errors: RecordErrors, slips: SlipRange) -> tuple[RunningPoint, HealthyFit]:
    """Find slip and offset whatever the asymmetry, and those of a healthy machine."""
    work = np.empty((5, 4))
    covariance = errors.covariance(HEALTHY, slips.rated)
    record = errors.compared(whatever_the_asymmetry(covariance), slips)
    found = [
        fit(record, errors.machine, HEALTHY, share * slips.rated, offset, work) for share, offset in STARTS
    ]
    _, slip, offset = max(found)
    covariance = errors.covariance(HEALTHY, slip)
    point = RunningPoint(slip, offset, covariance)
    # A long offset may explain an asymmetry; the healthy machine has it if that is likelier.
    record = errors.compared(covariance, slips)
    starts = [(slip, offset), *((share * slips.rated, late) for share, late in STARTS)]
    found = [fit(record, errors.machine, HEALTHY, *start, work) for start in starts]
    log_likelihood, slip, offset = max(found)
    return point, HealthyFit(log_likelihood + errors.log_constant(covariance), slip, offset)


def whatever_the_asymmetry(covariance: Array) -> Array:
    """Return a covariance of errors with which the negative sequence tells nothing of slip and offset."""
    freed = covariance.copy()
    freed[2, 2] += ANY_ASYMMETRY**2
    freed[3, 3] += ANY_ASYMMETRY**2
    return freed
