"""Global search: which winding, how bad, how loaded, how late the currents are (thesis Table 6.2)."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import OptimizeResult

from core.diagnosis.case import Case, thinned
from core.diagnosis.errors import DiagnosisError
from core.machines.base import Array, StatorModel
from core.machines.playback import Candidates, Playback
from core.optimisers import hcpa

HIGHEST_FAULT_LEVEL = 0.2
HIGHEST_LOAD_LEVEL = 1.25
WINDINGS = (0, 1, 2)

MAX_GLOBAL, MAX_LOCAL = 400, 120
FINENESS = 18
ADAPTIVENESS = 0.4
"""Section 6.5.2's setting, with a fineness that lets single coordinates reach a thousandth of their range."""


@dataclass(frozen=True, slots=True)
class Starts:
    """Best point found for each winding, as a batch of one each, and what finding them took."""

    by_winding: tuple[Candidates, Candidates, Candidates]
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
    result = METHODS[method](
        cost, ((0.0, HIGHEST_FAULT_LEVEL), (0.0, 2.0), (0.0, cycle), (0.0, HIGHEST_LOAD_LEVEL))
    )
    return Starts(
        by_winding=(_best(result, 0, cycle), _best(result, 1, cycle), _best(result, 2, cycle)),
        evaluations=int(result.nfev),
        message=str(result.message),
    )


def _hcpa(cost: Callable[[Array], Array], bounds: tuple[tuple[float, float], ...]) -> OptimizeResult:
    return hcpa.minimise(
        cost,
        bounds,
        adaptiveness=ADAPTIVENESS,
        fineness=FINENESS,
        exclusion=0.0,
        max_global=MAX_GLOBAL,
        max_local=MAX_LOCAL,
        allowed=(None, WINDINGS, None, None),
        batch=True,
    )


METHODS = {"hcpa": _hcpa}


def _best(result: OptimizeResult, winding: int, cycle: float) -> Candidates:
    """The best point of one winding; without any, the best of all moved to it."""
    of_winding = np.round(result.points[:, 1]) == winding
    values = np.where(of_winding, result.costs, np.inf)
    point = np.array(result.points[int(np.argmin(values))] if of_winding.any() else result.x)
    point[1] = winding
    if point[2] > 0.5 * cycle:
        point[2] -= cycle
    return candidates_at(point[np.newaxis])
