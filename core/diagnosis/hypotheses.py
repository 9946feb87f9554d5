"""Which explanation of the currents holds: healthy, shorted turns in one winding, or another asymmetry.

Shorted turns draw a current that is in one of three fixed directions to the voltage; any other asymmetry
(a sensor's gain, a joint, a winding) leaves a backward-turning current in any direction. So beside the
figures of the best winding we ask how much backward-turning current its fit leaves unexplained.
"""

from dataclasses import dataclass, replace

import numpy as np

from core.diagnosis.case import Case
from core.diagnosis.refinement import (
    FAULT_LEVEL,
    LOAD_LEVEL,
    PATH_RATIO,
    TIME_OFFSET,
    Fit,
    refine,
)
from core.diagnosis.search import Starts
from core.machines.playback import Candidates, Playback

GAIN_TOLERANCE = 0.01
"""Ratio error of a protection current transformer at rated current (IEC 61869-2, class 5P): 1 %."""
SHARE_UNEXPLAINED = 0.25
"""Of the asymmetry a winding's fit removes, what it may leave: parameters are known to some per cent only."""
PATH_WORTH, PATH_WORTH_SHARE = 0.007, 0.02
"""Unexplained current, of the forward one (what gains within their class can leave) and of the asymmetry,
beyond which a resistive path is tried."""
SIGNIFICANT = 3.0
"""Standard errors beyond which a level or a path counts as seen."""
PATH_START = 0.5
"""Path ratio that a fit starts from; beside it the least level a fit starts from, for its angle to count."""
LEVEL_START = 0.005


@dataclass(frozen=True, slots=True)
class Explanation:
    """The best winding's fit and what it leaves.

    winding: in the case's own labels.  asymmetry, unexplained: backward-turning current without and with the
    fault, as a fraction of the forward-turning one.  explained: whether shorted turns account for it.
    """

    winding: int
    fit: Fit
    healthy: Fit
    asymmetry: float
    unexplained: float
    explained: bool
    evaluations: int


def explain(case: Case, playback: Playback, starts: Starts) -> Explanation:
    """Refine every winding's best point and the healthy machine; choose the winding with the least residual.

    All windings have equally many unknowns, so the least residual is also the greatest likelihood. Turns
    bridged by a resistance draw a current nearer to the voltage's direction: where dead-shorted turns leave
    much unexplained, the path's resistance is fitted too, and taken where it is seen.
    """
    unknowns = (FAULT_LEVEL, LOAD_LEVEL, TIME_OFFSET)
    fits = [refine(case, playback, start, unknowns) for start in starts.by_winding]
    winding = _likeliest(fits)
    fit = fits[winding]
    healthy = refine(
        case, playback, replace(fit.candidate, fault_level=np.zeros(1)), (LOAD_LEVEL, TIME_OFFSET)
    )
    tried = [*fits, healthy]

    explained, before, after = _accounts_for_asymmetry(case, healthy, fit)
    if playback.model.knows_path and after > max(PATH_WORTH, PATH_WORTH_SHARE * before):
        through = [refine(case, playback, _with_path(one), (*unknowns, PATH_RATIO)) for one in fits]
        tried += through
        likeliest = _likeliest(through)
        path_explains, _, path_leaves = _accounts_for_asymmetry(case, healthy, through[likeliest])
        if (
            path_explains
            and _is_seen(through[likeliest], FAULT_LEVEL)
            and _is_seen(through[likeliest], PATH_RATIO)
        ):
            winding, fit, explained, after = likeliest, through[likeliest], True, path_leaves
    return Explanation(winding, fit, healthy, before, after, explained, sum(one.evaluations for one in tried))


def _likeliest(fits: list[Fit]) -> int:
    """The winding with the least residual among those with a level above zero; no winding has fewer turns
    shorted than none, so a level below zero only stands where there is no other."""
    possible = [fit.squared_error if fit.value(FAULT_LEVEL) > 0.0 else np.inf for fit in fits]
    return int(np.argmin(possible if np.isfinite(min(possible)) else [fit.squared_error for fit in fits]))


def _with_path(fit: Fit) -> Candidates:
    return replace(
        fit.candidate,
        fault_level=np.maximum(fit.candidate.fault_level, LEVEL_START),
        path_ratio=np.full(1, PATH_START),
    )


def _is_seen(fit: Fit, name: str) -> bool:
    error = fit.standard_error.get(name)
    return error is not None and fit.value(name) > SIGNIFICANT * error


def _accounts_for_asymmetry(case: Case, healthy: Fit, fit: Fit) -> tuple[bool, float, float]:
    measured = case.space_vector(case.current_ab[:, case.window.first : case.window.last])
    forward = abs(case.positive_sequence(measured))
    before = abs(case.negative_sequence(case.space_vector(healthy.residual_ab))) / forward
    shorted = fit if fit.value(FAULT_LEVEL) > 0.0 else healthy
    after = abs(case.negative_sequence(case.space_vector(shorted.residual_ab))) / forward
    return after <= max(GAIN_TOLERANCE, SHARE_UNEXPLAINED * before), before, after
