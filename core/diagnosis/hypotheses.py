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
    Fit,
    refine,
    time_offset,
)
from core.diagnosis.search import Starts
from core.machines.playback import Candidates, Playback

GAIN_TOLERANCE = 0.01
"""Ratio error of a protection current transformer at rated current (IEC 61869-2, class 5P): 1 %."""
SHARE_UNEXPLAINED = 0.25
"""Of the asymmetry a winding's fit removes, what it may leave: parameters are known to some per cent only."""
SIGNIFICANT = 3.0
"""Standard errors that an angle must be known by before a path resistance is fitted."""


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

    All windings have equally many unknowns, so the least residual is also the greatest likelihood.
    """
    offset = time_offset(case.frequency_hz)
    unknowns = (FAULT_LEVEL, LOAD_LEVEL, offset)
    fits = [refine(case, playback, start, unknowns) for start in starts.by_winding]
    winding = int(np.argmin([fit.squared_error for fit in fits]))
    fit = fits[winding]
    healthy = refine(case, playback, _without_fault(fit), (LOAD_LEVEL, offset))
    evaluations = sum(one.evaluations for one in (*fits, healthy))

    explained, before, after = _accounts_for_asymmetry(case, healthy, fit)
    if not explained and _is_significant(fit):
        through_path = refine(case, playback, fit.candidate, (*unknowns, PATH_RATIO))
        evaluations += through_path.evaluations
        path_explains, _, path_leaves = _accounts_for_asymmetry(case, healthy, through_path)
        if path_explains and FAULT_LEVEL.name in through_path.standard_error:
            fit, explained, after = through_path, True, path_leaves
    return Explanation(winding, fit, healthy, before, after, explained, evaluations)


def _without_fault(fit: Fit) -> Candidates:
    return replace(fit.candidate, fault_level=np.zeros(1))


def _is_significant(fit: Fit) -> bool:
    error = fit.standard_error.get(FAULT_LEVEL.name)
    return error is not None and fit.value(FAULT_LEVEL.name) > SIGNIFICANT * error


def _accounts_for_asymmetry(case: Case, healthy: Fit, fit: Fit) -> tuple[bool, float, float]:
    measured = case.space_vector(case.current_ab[:, case.window.first : case.window.last])
    forward = abs(case.positive_sequence(measured))
    before = abs(case.negative_sequence(case.space_vector(healthy.residual_ab))) / forward
    after = abs(case.negative_sequence(case.space_vector(fit.residual_ab))) / forward
    return after <= max(GAIN_TOLERANCE, SHARE_UNEXPLAINED * before), before, after
