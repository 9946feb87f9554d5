"""Choice of the hypothesis: healthy, shorted turns in one winding, or another asymmetry.

Shorted turns draw a current that is in one of three fixed directions to the voltage; any other asymmetry
(a sensor's gain, a joint, a winding) leaves a backward-turning current in any direction. So beside the
figures of the best winding we ask how much backward-turning current its fit leaves unexplained.
"""

from dataclasses import dataclass, replace
from math import hypot

import numpy as np

from core.diagnosis.case import Case
from core.diagnosis.fundamental import Fundamental
from core.diagnosis.operating_point import from_phasors
from core.diagnosis.paths import PathPosterior
from core.diagnosis.priors import GENERATING, OFFSET_S
from core.diagnosis.propagation import Known
from core.diagnosis.refinement import (
    FAULT_LEVEL,
    LOAD_LEVEL,
    OFFSET_SCALE_S,
    TIME_OFFSET,
    Fit,
    Refinement,
)
from core.diagnosis.search import Starts
from core.diagnosis.tolerance import Systematic
from core.machines.base import StatorModel

SHARE_UNEXPLAINED = 0.15
"""Share of the asymmetry that a winding's fit may leave: the path and the leakages of the shorted turns
are never known exactly."""
UNUSUAL = 2.5
"""Standard deviations of the offset's prior beyond which a fit is doubted, even of a small asymmetry."""
NOTHING_KNOWN = Known()
ONE_IN_A_HUNDRED = 2.15
"""Standard deviations that a complex error exceeds once in a hundred times: sqrt(ln 100)."""


@dataclass(frozen=True, slots=True)
class Explanation:
    """The best winding's fit and what it leaves.

    Parameters
    ----------
    record : Fundamental
        Phasors that are explained.
    winding : int
        0, 1 or 2 in the winding frame.
    fit : Fit
        Fit of the best winding.
    healthy : Fit
        Fit of the healthy machine.
    asymmetry, unexplained : float
        Backward-turning current without and with the fault, fractions of the forward-turning one.
    noise : float
        Standard deviation of the backward-turning current, the same fraction.
    evaluations : int
        Number of simulated candidates or evaluated points.
    level_interval, load_interval : tuple of float
        95 % intervals of the fault level and of the load over every hypothesis that holds for this winding:
        dead-shorted turns and paths of any resistance, as far as the record leaves them open. They hold the
        record's own noise and this ambiguity. They do not hold what sensors and parameters add at a given
        path; that is `Systematic`'s. Where one hypothesis stands alone they are `fit.interval(...)`.
    in_direction : bool
        Whether the current has the direction of shorted turns, dead or through one of the paths tried, as far
        as sensors and parameters let it be known. True where the asymmetry is too small to tell.
    """

    record: Fundamental
    winding: int
    fit: Fit
    healthy: Fit
    asymmetry: float
    unexplained: float
    noise: float
    evaluations: int
    level_interval: tuple[float, float]
    load_interval: tuple[float, float]
    in_direction: bool


def explain(
    case: Case, phasors: Fundamental, model: StatorModel, starts: Starts, known: Known = NOTHING_KNOWN
) -> Explanation:
    """Refine every winding's best point and the healthy machine; choose the winding that leaves least.

    All windings have equally many unknowns, so the least residual is also the greatest likelihood. Turns
    bridged by a resistance draw a current nearer to the voltage's direction, which a long offset and too
    small a load imitate. So wherever the asymmetry exceeds what chance makes of it, or offset or load are not
    usual, every path is weighed against dead-shorted turns (`PathPosterior`). The fit of dead-shorted turns
    is kept where the posterior finds it likeliest; else the posterior's own likeliest is taken.

    Parameters
    ----------
    case : Case
        The record in the winding frame.
    phasors : Fundamental
        Its phasors at supply frequency.
    model : StatorModel
        Machine model of the fault.
    starts : Starts
        Best point of each winding.
    known : Known, optional
        What a baseline has taken off of the sensors' and the parameters' errors.

    Returns
    -------
    Explanation
        The chosen winding's fit and what it leaves.
    """
    unknowns = (FAULT_LEVEL, LOAD_LEVEL, TIME_OFFSET)
    refinement = Refinement(case, phasors, model, starts.best)
    fits, tried = [], []
    for winding, found in enumerate(starts.by_winding):
        tried.append(refinement.fit(found, unknowns))
        if abs(tried[-1].value(TIME_OFFSET)) > OFFSET_SCALE_S:
            # A light load on a strongly unbalanced supply has two minima; the other one is without offset.
            directly = from_phasors(refinement.record, case.motor, winding)
            tried.append(refinement.fit(directly, unknowns))
            fits.append(min(tried[-2:], key=_misfit))
        else:
            fits.append(tried[-1])
    winding = _likeliest(fits)
    fit = fits[winding]
    # Far from here where many turns are shorted: the windings that are not come to stand beside it.
    nearest = min(fits, key=_size)
    healthy = refinement.fit(replace(nearest.candidate, fault_level=np.zeros(1)), (LOAD_LEVEL, TIME_OFFSET))
    tried.append(healthy)

    intervals = {name: fit.interval(name) for name in (FAULT_LEVEL, LOAD_LEVEL)}
    in_direction = True
    evaluations = sum(one.evaluations for one in tried)
    if model.knows_path and not case.voltages_assumed:
        posterior = PathPosterior(case, refinement, known)
        chance = ONE_IN_A_HUNDRED * posterior.backward_A
        if abs(healthy.left) > chance or not (_is_usual(fit) and _is_usual(healthy)):
            if not posterior.holds(fit):
                winding, fit = posterior.winding, posterior.likeliest()
                healthy = posterior.without_fault(fit)
            in_direction = posterior.explains or abs(healthy.left) <= chance
            intervals = {name: _joined(fit.interval(name), posterior.interval(name)) for name in intervals}
        evaluations += posterior.evaluations
    forward = abs(refinement.record.current.forward)
    return Explanation(
        record=refinement.record,
        winding=winding,
        fit=fit,
        healthy=healthy,
        asymmetry=abs(healthy.left) / forward,
        unexplained=abs(_left(fit, healthy)) / forward,
        noise=refinement.backward_noise_A / forward,
        evaluations=evaluations,
        level_interval=intervals[FAULT_LEVEL],
        load_interval=intervals[LOAD_LEVEL],
        in_direction=in_direction,
    )


def limit_of_chance(explanation: Explanation, tolerance: Systematic) -> float:
    """Return the asymmetry that noise, sensors and parameters reach once in a hundred records.

    It is a backward-turning current.

    Parameters
    ----------
    explanation : Explanation
        The hypothesis that explains the currents best.
    tolerance : Systematic
        Errors that no averaging reduces.

    Returns
    -------
    float
        Fraction of the forward-turning current.
    """
    return ONE_IN_A_HUNDRED * hypot(tolerance.backward, explanation.noise)


def is_explained(explanation: Explanation, tolerance: Systematic) -> bool:
    """Return whether shorted turns account for the asymmetry.

    They do where what they leave is within the limit of chance, or a small share of the asymmetry.

    Parameters
    ----------
    explanation : Explanation
        The hypothesis that explains the currents best.
    tolerance : Systematic
        Errors that no averaging reduces.

    Returns
    -------
    bool
        Whether they do.
    """
    allowed = max(limit_of_chance(explanation, tolerance), SHARE_UNEXPLAINED * explanation.asymmetry)
    return (
        explanation.in_direction
        and explanation.fit.value(FAULT_LEVEL) > 0.0
        and explanation.unexplained <= allowed
    )


def is_another_asymmetry(explanation: Explanation, tolerance: Systematic) -> bool:
    """Return whether the currents show an asymmetry that shorted turns do not account for.

    Parameters
    ----------
    explanation : Explanation
        The hypothesis that explains the currents best.
    tolerance : Systematic
        Errors that no averaging reduces.

    Returns
    -------
    bool
        Whether they do.
    """
    if is_explained(explanation, tolerance):
        return False
    return not explanation.in_direction or explanation.unexplained > limit_of_chance(explanation, tolerance)


def _likeliest(fits: list[Fit]) -> int:
    """Return the winding that explains the record best, among those with a level above zero.

    No winding has fewer turns shorted than none, so a level below zero only stands where there is no other.
    """
    misfit = np.array([fit.misfit for fit in fits])
    possible = np.array([fit.value(FAULT_LEVEL) > 0.0 for fit in fits])
    return int(np.argmin(np.where(possible, misfit, np.inf) if possible.any() else misfit))


def _misfit(fit: Fit) -> float:
    return fit.misfit


def _is_usual(fit: Fit) -> bool:
    return abs(fit.value(TIME_OFFSET)) < UNUSUAL * OFFSET_S and fit.value(LOAD_LEVEL) > -GENERATING


def _size(fit: Fit) -> float:
    return abs(fit.value(FAULT_LEVEL))


def _joined(one: tuple[float, float], other: tuple[float, float]) -> tuple[float, float]:
    return min(one[0], other[0]), max(one[1], other[1])


def _left(fit: Fit, healthy: Fit) -> complex:
    """Backward-turning current that the fault leaves; a level below zero is no fault and explains nothing."""
    return fit.left if fit.value(FAULT_LEVEL) > 0.0 else healthy.left
