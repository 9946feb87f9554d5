"""Global search: which winding, how bad, how loaded, how late the currents are (thesis Table 6.2)."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import OptimizeResult

from core.diagnosis.case import Case, thinned
from core.diagnosis.errors import DiagnosisError
from core.diagnosis.methods import Method
from core.machines.base import Array, StatorModel
from core.machines.candidates import Candidates
from core.machines.playback import Playback
from core.optimisers import genetic, hcpa, pattern_search

HIGHEST_FAULT_LEVEL = 0.2
HIGHEST_LOAD_LEVEL = 1.25
WINDINGS = (0, 1, 2)

MAX_GLOBAL, MAX_LOCAL = 400, 120
FINENESS = 18
ADAPTIVENESS = 0.4
"""Section 6.5.2's setting, with a fineness that lets single coordinates reach a thousandth of their range."""
HYBRID_GLOBAL, HYBRID_ADAPTIVENESS = 60, 0.7
"""Few points, spread widely: each winding's best only has to lie in the right valley.

docs/evidence/optimisers.md compares these settings with others.
"""
SAMPLES = 60
"""Latin hypercube points of which the pattern search begins at the best (section 6.5.1)."""
PATTERN_EVALUATIONS = 500
FINEST_MESH = 1e-3
SEED = 0
"""Of the methods that draw random points: a record is diagnosed alike every time."""


@dataclass(frozen=True, slots=True)
class Starts:
    """Best point found for each winding, as a batch of one each, and what finding them took."""

    by_winding: tuple[Candidates, Candidates, Candidates]
    best: Candidates
    evaluations: int
    message: str


def candidates_at(points: Array) -> Candidates:
    """Candidates from search points (m, 4): mu_f, theta_f, T_d, LL."""
    return Candidates(
        fault_level=np.ascontiguousarray(points[:, 0]),
        winding=np.round(points[:, 1]).astype(np.int64),
        load_level=np.ascontiguousarray(points[:, 3]),
        time_offset_s=np.ascontiguousarray(points[:, 2]),
        path_ratio=np.zeros(len(points)),
    )


def search(case: Case, model: StatorModel, method: str) -> Starts:
    """Run the optimiser called `method` on the thinned record; hand on its best point for each winding.

    Raises DiagnosisError for a method that does not exist.
    """
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
    """What a method minimises over points (m, 4), as in `candidates_at`; T_d is known up to a cycle [s]."""

    cost: Callable[[Array], Array]
    cycle_s: float

    def bounds(self, lowest_winding: float, highest_winding: float) -> tuple[tuple[float, float], ...]:
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


def _hcpa(objective: Objective) -> OptimizeResult:
    return hcpa.minimise(
        objective.cost,
        objective.choice,
        adaptiveness=ADAPTIVENESS,
        fineness=FINENESS,
        exclusion=0.0,
        max_global=MAX_GLOBAL,
        max_local=MAX_LOCAL,
        allowed=(None, WINDINGS, None, None),
        batch=True,
    )


def _hybrid(objective: Objective) -> OptimizeResult:
    """The global stage alone: refinement.py makes every winding's best point precise, on phasors."""
    return hcpa.minimise(
        objective.cost,
        objective.choice,
        adaptiveness=HYBRID_ADAPTIVENESS,
        fineness=FINENESS,
        exclusion=0.0,
        max_global=HYBRID_GLOBAL,
        max_local=0,
        allowed=(None, WINDINGS, None, None),
        batch=True,
    )


def _genetic(objective: Objective) -> OptimizeResult:
    return genetic.minimise(objective.cost, objective.rounding, seed=SEED, batch=True)


def _pattern_search(objective: Objective) -> OptimizeResult:
    return pattern_search.minimise(
        objective.cost,
        objective.rounding,
        smallest_mesh=FINEST_MESH,
        max_evaluations=PATTERN_EVALUATIONS,
        batch=True,
    )


def _pattern_search_lhs(objective: Objective) -> OptimizeResult:
    return pattern_search.minimise(
        objective.cost,
        objective.rounding,
        samples=SAMPLES,
        smallest_mesh=FINEST_MESH,
        max_evaluations=PATTERN_EVALUATIONS,
        seed=SEED,
        batch=True,
    )


METHODS: dict[str, Callable[[Objective], OptimizeResult]] = {
    Method.HYBRID: _hybrid,
    Method.HCPA: _hcpa,
    Method.GENETIC: _genetic,
    Method.PATTERN_SEARCH: _pattern_search,
    Method.PATTERN_SEARCH_LHS: _pattern_search_lhs,
}


def _best(result: OptimizeResult, winding: int, cycle: float) -> Candidates:
    """The best point of one winding; without any, the best of all moved to it."""
    of_winding = np.round(result.points[:, 1]) == winding
    values = np.where(of_winding, result.costs, np.inf)
    point = np.array(result.points[int(np.argmin(values))] if of_winding.any() else result.x)
    point[1] = winding
    if point[2] > 0.5 * cycle:
        point[2] -= cycle
    return candidates_at(point[np.newaxis])
