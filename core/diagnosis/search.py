"""Global search: which winding, how bad, how loaded, how late the currents are (thesis Table 6.2)."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from core.diagnosis.case import Case, thinned
from core.diagnosis.errors import DiagnosisError
from core.diagnosis.methods import Method
from core.machines.base import Array, StatorModel
from core.machines.candidates import Candidates
from core.machines.playback import Playback
from core.optimisers import hcpa
from core.optimisers.evaluations import SearchResult
from core.optimisers.hcpa import HcpaSettings
from core.optimisers.objective import as_batch

if TYPE_CHECKING:
    from scipy.optimize import OptimizeResult

HIGHEST_FAULT_LEVEL = 0.2
HIGHEST_LOAD_LEVEL = 1.25
WINDINGS = (0, 1, 2)

FINENESS = 18
"""Fineness at which single coordinates reach a thousandth of their range."""
THESIS_SETTINGS = HcpaSettings(
    adaptiveness=0.4, fineness=FINENESS, max_global=400, max_local=120, allowed=(None, WINDINGS, None, None)
)
"""Section 6.5.2's setting, with a greater fineness."""
HYBRID_SETTINGS = HcpaSettings(
    adaptiveness=0.7, fineness=FINENESS, max_global=60, max_local=0, allowed=(None, WINDINGS, None, None)
)
"""Few points, spread widely: each winding's best only has to lie in the right valley.

The refinement then makes it precise, on phasors. docs/evidence/optimisers.md compares such settings.
"""
SAMPLES = 60
"""Latin hypercube points of which the pattern search begins at the best (section 6.5.1)."""
PATTERN_EVALUATIONS = 500
FINEST_MESH = 1e-3
SEED = 0
"""Seed of the methods that draw random points: a record is diagnosed alike every time."""


@dataclass(frozen=True, slots=True)
class Starts:
    """Best point found for each winding, and what finding them took.

    Parameters
    ----------
    by_winding : tuple of Candidates
        Best point of each winding, a batch of one each.
    best : Candidates
        The best of all.
    evaluations : int
        Number of simulated candidates or evaluated points.
    message : str
        Why the search ended.
    """

    by_winding: tuple[Candidates, Candidates, Candidates]
    best: Candidates
    evaluations: int
    message: str


def candidates_at(points: Array) -> Candidates:
    """Make candidates of search points."""
    return Candidates(
        fault_level=np.ascontiguousarray(points[:, 0]),
        winding=np.round(points[:, 1]).astype(np.int64),
        load_level=np.ascontiguousarray(points[:, 3]),
        time_offset_s=np.ascontiguousarray(points[:, 2]),
    )


def search(case: Case, model: StatorModel, method: str) -> Starts:
    """Run a search method on the thinned record; return its best point for each winding."""
    if method not in METHODS:
        raise DiagnosisError(f"method {method!r} is unknown; known: {', '.join(METHODS)}")

    coarse = thinned(case)
    playback = Playback(model, case.motor, coarse.supply, coarse.window)

    def cost(points: Array) -> Array:
        return playback.squared_error(candidates_at(points), coarse.current_ab)

    cycle = 1.0 / case.frequency_hz
    result = METHODS[method](Objective(cost, cycle))
    by_winding = (_best(result, 0, cycle), _best(result, 1, cycle), _best(result, 2, cycle))
    return Starts(
        by_winding=by_winding,
        best=by_winding[round(result.x[1])],
        evaluations=int(result.nfev),
        message=str(result.message),
    )


@dataclass(frozen=True, slots=True)
class Objective:
    """What a method minimises over points (m, 4), as in `candidates_at`.

    Parameters
    ----------
    cost : callable
        Squared errors (m,) of points (m, 4) [A^2].
    cycle_s : float
        Period of the supply, up to which T_d is known [s].
    """

    cost: Callable[[Array], Array]
    cycle_s: float

    def bounds(self, lowest_winding: float, highest_winding: float) -> tuple[tuple[float, float], ...]:
        """Return the box that is searched."""
        return (
            (0.0, HIGHEST_FAULT_LEVEL),
            (lowest_winding, highest_winding),
            (0.0, self.cycle_s),
            (0.0, HIGHEST_LOAD_LEVEL),
        )

    @property
    def choice(self) -> tuple[tuple[float, float], ...]:
        """Bounds for a method that only tries the windings."""
        return self.bounds(0.0, 2.0)

    @property
    def rounding(self) -> tuple[tuple[float, float], ...]:
        """Bounds for a method that knows no choice: each winding has a third of the range."""
        return self.bounds(-0.5, 2.5)


def _hcpa(objective: Objective) -> SearchResult:
    return hcpa.search(as_batch(objective.cost, batch=True), objective.choice, THESIS_SETTINGS)


def _hybrid(objective: Objective) -> SearchResult:
    return hcpa.search(as_batch(objective.cost, batch=True), objective.choice, HYBRID_SETTINGS)


# The methods below are chosen rarely, and bring the import of scipy.optimize or scipy.stats with them.
def _genetic(objective: Objective) -> "OptimizeResult":
    from core.optimisers import genetic

    return genetic.minimise(objective.cost, objective.rounding, seed=SEED, batch=True)


def _pattern_search(objective: Objective) -> "OptimizeResult":
    from core.optimisers import pattern_search

    return pattern_search.minimise(
        objective.cost,
        objective.rounding,
        smallest_mesh=FINEST_MESH,
        max_evaluations=PATTERN_EVALUATIONS,
        batch=True,
    )


def _pattern_search_lhs(objective: Objective) -> "OptimizeResult":
    from core.optimisers import pattern_search

    return pattern_search.minimise(
        objective.cost,
        objective.rounding,
        samples=SAMPLES,
        smallest_mesh=FINEST_MESH,
        max_evaluations=PATTERN_EVALUATIONS,
        seed=SEED,
        batch=True,
    )


METHODS: dict[str, Callable[[Objective], "SearchResult | OptimizeResult"]] = {
    Method.HYBRID: _hybrid,
    Method.HCPA: _hcpa,
    Method.GENETIC: _genetic,
    Method.PATTERN_SEARCH: _pattern_search,
    Method.PATTERN_SEARCH_LHS: _pattern_search_lhs,
}


def _best(result: "SearchResult | OptimizeResult", winding: int, cycle: float) -> Candidates:
    """Return the best point of one winding; without any, the best of all moved to it."""
    of_winding = np.round(result.points[:, 1]) == winding
    values = np.where(of_winding, result.costs, np.inf)
    point = np.array(result.points[int(np.argmin(values))] if of_winding.any() else result.x)
    point[1] = winding
    if point[2] > 0.5 * cycle:
        point[2] -= cycle
    return candidates_at(point[np.newaxis])
