"""Our optimisers and others' behind one call: a box, an objective, a budget, a seed; every point is kept.

All work on the unit box; the objective turns it into its own. A method ends by itself or when the budget is
spent, whichever comes first. SG++ runs in an environment of its own (see sgpp_worker.py).
"""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

import cma
import nlopt
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import Bounds, direct, dual_annealing, shgo

from benchmarks.optimisers import multistart
from benchmarks.optimisers.multistart import Refinement
from core.optimisers import genetic, hcpa, pattern_search

Array = NDArray[np.float64]
BUDGET = 2_000
"""Evaluations of a run."""
CMA_STEP = 0.25
"""First standard deviation, of the unit box."""
CMA_RESTARTS = 8
ROUNDS = 6
"""Of multistart: more than any budget here."""


class BudgetSpent(Exception):  # noqa: N818 - it ends a search, and is no error
    """Raised out of a peer's search when its evaluations are used up."""


def _never(points: Array, costs: Array) -> bool:
    del points, costs
    return False


@dataclass(frozen=True, slots=True)
class Task:
    """What is to be minimised over [0, 1]^d: costs (m,) of points (m, d).

    residuals: vectors whose squares sum to the cost, where it is such a sum.
    choices: coordinates that know only the values 0, 0.5 and 1.  periodic: those whose bounds are the same.
    first_points: HCPA's points in multistart's first round.
    is_enough: whether new points (m, d) with costs (m,) let the search end early.
    """

    cost: Callable[[Array], Array]
    dimensions: int
    residuals: Callable[[Array], Array] | None = None
    choices: tuple[int, ...] = ()
    periodic: tuple[int, ...] = ()
    is_enough: Callable[[Array, Array], bool] = _never
    first_points: int = 100


class Trace:
    """The objective of one run, point by point, and what became of it."""

    def __init__(self, task: Task, budget: int) -> None:
        self._task = task
        self._budget = budget
        self.points: list[Array] = []
        self.costs: list[float] = []

    def at(self, point: Array) -> float:
        """Cost of one point (d,); what a peer tries outside the box is put on its face."""
        if len(self.costs) >= self._budget:
            raise BudgetSpent
        inside = np.clip(np.asarray(point, dtype=np.float64), 0.0, 1.0)
        cost = float(self._task.cost(inside[np.newaxis])[0])
        self.points.append(inside)
        self.costs.append(cost)
        if self._task.is_enough(inside[np.newaxis], np.array([cost])):
            raise BudgetSpent
        return cost

    def take(self, points: Array, costs: Array) -> None:
        """Adopt what one of our own optimisers has evaluated."""
        self.points = list(points[: self._budget])
        self.costs = costs[: self._budget].tolist()


Method = Callable[[Task, int, int, Trace], None]
"""(task, budget, seed, trace): a search that leaves its points in the trace."""


def _allowed(task: Task) -> list[tuple[float, ...] | None] | None:
    if not task.choices:
        return None
    return [(0.0, 0.5, 1.0) if axis in task.choices else None for axis in range(task.dimensions)]


def _box(task: Task) -> list[tuple[float, float]]:
    return [(0.0, 1.0)] * task.dimensions


def _unit(task: Task) -> Bounds:
    return Bounds(np.zeros(task.dimensions), np.ones(task.dimensions))


def our_hcpa(task: Task, budget: int, seed: int, trace: Trace) -> None:
    """Table 4.1's parameters, as printed; two thirds of the budget global."""
    del seed
    found = hcpa.minimise(
        task.cost, _box(task), max_global=2 * budget // 3, max_local=budget - 2 * budget // 3,
        allowed=_allowed(task), batch=True, callback=task.is_enough,
    )  # fmt: skip
    trace.take(found.points, found.costs)


def our_hcpa_deep(task: Task, budget: int, seed: int, trace: Trace) -> None:
    """HCPA without the limits that stop it short: fineness 40, no exclusion, a quarter of it global."""
    del seed
    found = hcpa.minimise(
        task.cost, _box(task), fineness=40, exclusion=0.0, adaptiveness=0.4, max_global=budget // 4,
        max_local=budget - budget // 4, allowed=_allowed(task), batch=True, callback=task.is_enough,
    )  # fmt: skip
    trace.take(found.points, found.costs)


def our_multistart(task: Task, budget: int, seed: int, trace: Trace) -> None:
    """One start for each choice or three without any; rounds until the budget is spent."""
    del seed
    found = multistart.minimise(
        task.cost, _box(task), residuals=task.residuals, allowed=_allowed(task), periodic=task.periodic,
        refinement=Refinement(starts=1 if task.choices else 3, rounds=ROUNDS),
        max_global=task.first_points, max_evaluations=budget, batch=True, callback=task.is_enough,
    )  # fmt: skip
    trace.take(found.points, found.costs)


def our_genetic(task: Task, budget: int, seed: int, trace: Trace) -> None:
    """The thesis's settings, with as many generations as the budget holds."""
    found = genetic.minimise(
        task.cost, _box(task), generations=max(1, (budget - 20) // 15), seed=seed, batch=True,
        callback=task.is_enough,
    )  # fmt: skip
    trace.take(found.points, found.costs)


def our_pattern_search(task: Task, budget: int, seed: int, trace: Trace) -> None:
    found = pattern_search.minimise(
        task.cost, _box(task), samples=min(60, budget), max_evaluations=budget, seed=seed, batch=True,
        callback=task.is_enough,
    )  # fmt: skip
    trace.take(found.points, found.costs)


def nlopt_direct_l(task: Task, budget: int, seed: int, trace: Trace) -> None:
    del seed

    def objective(point: Array, gradient: Array) -> float:
        del gradient
        return trace.at(point)

    search = nlopt.opt(nlopt.GN_DIRECT_L, task.dimensions)
    search.set_lower_bounds(np.zeros(task.dimensions))
    search.set_upper_bounds(np.ones(task.dimensions))
    search.set_min_objective(objective)
    search.set_maxeval(budget)
    search.optimize(np.full(task.dimensions, 0.5))


def scipy_direct(task: Task, budget: int, seed: int, trace: Trace) -> None:
    del seed
    direct(
        trace.at, _unit(task), maxfun=budget, maxiter=100_000, vol_tol=0.0, len_tol=0.0, locally_biased=True
    )


def scipy_shgo(task: Task, budget: int, seed: int, trace: Trace) -> None:
    """Rounds of 64 Sobol points each with local searches, until the budget ends it."""
    del seed, budget
    shgo(trace.at, _unit(task), n=64, iters=20, sampling_method="sobol")


def scipy_dual_annealing(task: Task, budget: int, seed: int, trace: Trace) -> None:
    dual_annealing(
        trace.at, _unit(task), maxfun=budget, maxiter=100_000,
        rng=seed,
    )  # fmt: skip


def cma_es(task: Task, budget: int, seed: int, trace: Trace) -> None:
    """With restarts of doubling population (IPOP), each from a random point."""
    random = np.random.default_rng(seed)
    cma.fmin(
        trace.at,
        lambda: random.uniform(size=task.dimensions),
        CMA_STEP,
        {"bounds": [0, 1], "maxfevals": budget, "seed": seed + 1, "verbose": -9, "tolfun": 1e-14},
        restarts=CMA_RESTARTS,
    )


METHODS: dict[str, Method] = {
    "multistart": our_multistart,
    "HCPA, Table 4.1": our_hcpa,
    "HCPA, deep": our_hcpa_deep,
    "genetic": our_genetic,
    "pattern search + LHS": our_pattern_search,
    "NLopt DIRECT-L": nlopt_direct_l,
    "scipy direct": scipy_direct,
    "scipy SHGO": scipy_shgo,
    "scipy dual annealing": scipy_dual_annealing,
    "CMA-ES": cma_es,
}
KNOW_CHOICES = ("multistart", "HCPA, Table 4.1", "HCPA, deep")
"""Methods that can be told that a coordinate has three values; for the others it is a rounded range."""


def run(method: Method, task: Task, *, budget: int, seed: int) -> tuple[Array, Array]:
    """Points (n, d) and costs (n,) of a method, n at most the budget."""
    trace = Trace(task, budget)
    with suppress(BudgetSpent, nlopt.ForcedStop):
        method(task, budget, seed, trace)
    return np.array(trace.points).reshape(-1, task.dimensions), np.array(trace.costs)


def first_success(costs: Array, close: NDArray[np.bool_]) -> float:
    """Evaluations after which the best point so far is close; infinity where it never is."""
    improves = costs < np.concatenate([[np.inf], np.minimum.accumulate(costs)[:-1]])
    reached = np.flatnonzero(improves & close)
    return float(reached[0] + 1) if reached.size else float("inf")
