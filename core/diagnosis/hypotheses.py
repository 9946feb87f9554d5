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
from core.diagnosis.refinement import (
    FAULT_LEVEL,
    LOAD_LEVEL,
    OFFSET_SCALE_S,
    PATH_RATIO,
    TIME_OFFSET,
    Fit,
    Refinement,
)
from core.diagnosis.search import Starts
from core.diagnosis.tolerance import Systematic
from core.machines.base import StatorModel
from core.machines.candidates import Candidates

SHARE_UNEXPLAINED = 0.15
"""Share of the asymmetry that a winding's fit may leave: the path and the leakages of the shorted turns
are never known exactly."""
PATH_THRESHOLD, PATH_THRESHOLD_SHARE = 0.007, 0.02
"""Unexplained current, of the forward one (what current sensors within their class can leave) and of the
asymmetry, beyond which a resistive path is tried."""
SIGNIFICANT = 3.0
"""Standard errors above which a level or a path is significant."""
ONE_IN_A_HUNDRED = 2.15
"""Standard deviations that a complex error exceeds once in a hundred times: sqrt(ln 100)."""
PATH_START = 0.5
"""Path ratio and least level at which a fit starts; the level is above zero so that its angle counts."""
LEVEL_START = 0.005


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


def explain(case: Case, model: StatorModel, starts: Starts) -> Explanation:
    """Refine every winding's best point and the healthy machine; choose the winding that leaves least.

    All windings have equally many unknowns, so the least residual is also the greatest likelihood. Turns
    bridged by a resistance draw a current nearer to the voltage's direction: where dead-shorted turns leave
    much unexplained, the path's resistance is fitted too, and taken where it is seen.

    Parameters
    ----------
    case : Case
        The record in the winding frame.
    model : StatorModel
        Machine model of the fault.
    starts : Starts
        Best point of each winding.

    Returns
    -------
    Explanation
        The chosen winding's fit and what it leaves.
    """
    unknowns = (FAULT_LEVEL, LOAD_LEVEL, TIME_OFFSET)
    refinement = Refinement(case, model, starts.best)
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

    forward = abs(refinement.record.current.forward)
    before, after = abs(healthy.left) / forward, abs(_left(fit, healthy)) / forward
    if model.knows_path and after > max(PATH_THRESHOLD, PATH_THRESHOLD_SHARE * before):
        through = [refinement.fit(_with_path(one), (*unknowns, PATH_RATIO)) for one in fits]
        tried += through
        likeliest = _likeliest(through)
        bridged = through[likeliest]
        left = abs(_left(bridged, healthy)) / forward
        if left < after and _is_seen(bridged, FAULT_LEVEL) and _is_seen(bridged, PATH_RATIO):
            winding, fit, after = likeliest, bridged, left
    return Explanation(
        record=refinement.record,
        winding=winding,
        fit=fit,
        healthy=healthy,
        asymmetry=before,
        unexplained=after,
        noise=refinement.backward_noise_A / forward,
        evaluations=sum(one.evaluations for one in tried),
        level_interval=fit.interval(FAULT_LEVEL),
        load_interval=fit.interval(LOAD_LEVEL),
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
    return explanation.fit.value(FAULT_LEVEL) > 0.0 and explanation.unexplained <= allowed


def _likeliest(fits: list[Fit]) -> int:
    """Return the winding that explains the record best, among those with a level above zero.

    No winding has fewer turns shorted than none, so a level below zero only stands where there is no other.
    """
    misfit = np.array([fit.misfit for fit in fits])
    possible = np.array([fit.value(FAULT_LEVEL) > 0.0 for fit in fits])
    return int(np.argmin(np.where(possible, misfit, np.inf) if possible.any() else misfit))


def _misfit(fit: Fit) -> float:
    return fit.misfit


def _size(fit: Fit) -> float:
    return abs(fit.value(FAULT_LEVEL))


def _with_path(fit: Fit) -> Candidates:
    return replace(
        fit.candidate,
        fault_level=np.maximum(fit.candidate.fault_level, LEVEL_START),
        path_ratio=np.full(1, PATH_START),
    )


def _is_seen(fit: Fit, name: str) -> bool:
    error = fit.standard_error.get(name)
    return error is not None and fit.value(name) > SIGNIFICANT * error


def _left(fit: Fit, healthy: Fit) -> complex:
    """Backward-turning current that the fault leaves; a level below zero is no fault and explains nothing."""
    return fit.left if fit.value(FAULT_LEVEL) > 0.0 else healthy.left
