"""The thesis's way to a fault: a global search on the playback, then a local refinement on the phasors.

It serves the models that know no axis and no leakage: the split winding and the thesis's additional winding.
"""

from dataclasses import dataclass

from core.diagnosis.case import Case
from core.diagnosis.fundamental import Fundamental
from core.diagnosis.refinement import FAULT_LEVEL, LOAD_LEVEL, TIME_OFFSET, Fit, Refinement
from core.diagnosis.search import search
from core.machines.base import StatorModel


@dataclass(frozen=True, slots=True)
class Searched:
    """What a search and its refinement found.

    Parameters
    ----------
    fits : tuple of Fit
        Fit of each winding.
    evaluations : int
        Number of simulated candidates and of evaluated points.
    """

    fits: tuple[Fit, Fit, Fit]
    evaluations: int

    @property
    def best(self) -> Fit:
        """The fit that explains the record best, among those with a level above zero."""
        possible = [one for one in self.fits if one.value(FAULT_LEVEL) > 0.0] or list(self.fits)
        return min(possible, key=lambda one: one.misfit)


def searched(case: Case, phasors: Fundamental, model: StatorModel, method: str) -> Searched:
    """Search the fault of a record, and refine the best point of each winding."""
    starts = search(case, model, method)
    refinement = Refinement(case, phasors, model, starts.best)
    unknowns = (FAULT_LEVEL, LOAD_LEVEL, TIME_OFFSET)
    a, b, c = (refinement.fit(start, unknowns) for start in starts.by_winding)
    evaluations = starts.evaluations + sum(one.evaluations for one in (a, b, c))
    return Searched((a, b, c), evaluations)
