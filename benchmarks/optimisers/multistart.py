"""Global search, then local refinement of the best few separated points.

HCPA finds the valleys, in few evaluations and never to the last digit; a local search is fast once it is in
the right one (thesis section 5.3.2). Where the cost is a sum of squares and its residuals are given, the
refinement is least squares; else scipy's L-BFGS-B (Byrd, Lu, Nocedal and Zhu, SIAM J. Sci. Comput. 16, 1995,
doi:10.1137/0916069) with difference quotients.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import OptimizeResult
from scipy.optimize import minimize as scipy_minimize

from benchmarks.optimisers import least_squares
from core.optimisers import hcpa
from core.optimisers.evaluations import Evaluations, Halted
from core.optimisers.objective import (
    Array,
    BatchFunction,
    Bounds,
    Callback,
    OptimiserError,
    PointFunction,
    as_batch,
    checked_bounds,
    checked_count,
)

DIFFERENCE = 1e-6
"""Step of the difference quotients of a cost, a fraction of the box."""

AxisMask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Refinement:
    """How the local searches begin and end.

    starts: points refined in a round, for each combination of values of the coordinates with `allowed` ones.
    separation: least distance of two of them in some coordinate, a fraction of the box.
    rounds: in each after the first the global search goes on to twice as many points.
    tolerance: of the end, in fractions of the box.
    """

    starts: int = 3
    separation: float = 0.1
    rounds: int = 1
    tolerance: float = 1e-6


def minimise(
    fun: PointFunction | BatchFunction,
    bounds: Bounds,
    *,
    residuals: least_squares.Residuals | None = None,
    refinement: Refinement | None = None,
    adaptiveness: float = 0.7,
    fineness: int = 18,
    exclusion: float = 0.0,
    max_global: int = 100,
    max_evaluations: int = 1_000,
    allowed: Sequence[Sequence[float] | None] | None = None,
    periodic: Sequence[int] = (),
    batch: bool = False,
    callback: Callback | None = None,
) -> OptimizeResult:
    """Minimise `fun` over a box. There is no chance in it: the same arguments take the same path.

    residuals: vectors (n,) of a point whose squares sum to `fun`; with batch=True (m, n) of points (m, d).
    adaptiveness, fineness, exclusion, max_global, allowed: of the global search (hcpa.minimise).
    periodic: coordinates whose two bounds are one and the same (an angle, a delay of whole cycles): a local
    search leaves through one and enters through the other.
    max_evaluations: of both stages.  batch: `fun` takes points (m, d).

    Returns x, fun, nfev, nit (starts refined), success, message, points (nfev, d), costs (nfev,),
    starts (nit, d).
    Raises OptimiserError for impossible arguments.
    """
    box = checked_bounds(bounds)
    refinement = refinement or Refinement()
    checked_count("max_evaluations", max_evaluations, 1)
    checked_count("starts", refinement.starts, 1)
    checked_count("rounds", refinement.rounds, 1)
    whole = Evaluations(
        as_batch(fun, batch=batch), box, callback=callback, budget=max_evaluations, staged=True
    )
    if any(axis not in range(box.dimensions) for axis in periodic):
        raise OptimiserError(
            f"periodic: expected coordinates from 0 to {box.dimensions - 1}, found {list(periodic)}"
        )
    closed = np.isin(np.arange(box.dimensions), periodic)
    free = np.array([allowed is None or allowed[axis] is None for axis in range(box.dimensions)])
    unit_allowed = None
    if allowed is not None:
        unit_allowed = [
            None if values is None else ((np.asarray(values) - low) / (high - low)).tolist()
            for values, low, high in zip(allowed, box.lower, box.upper, strict=True)
        ]
    starts = np.empty((0, box.dimensions))
    refined = 0
    try:
        for doubled in range(refinement.rounds):
            # What it evaluated in the last round is looked up: only the further points cost anything.
            found = hcpa.minimise(
                whole, [(0.0, 1.0)] * box.dimensions, adaptiveness=adaptiveness, fineness=fineness,
                exclusion=exclusion, max_global=max_global << doubled, max_local=0, allowed=unit_allowed,
                batch=True,
            )  # fmt: skip
            new = separated(found.points, found.costs, starts, refinement, free, closed)
            starts = np.concatenate([starts, new])
            for start in new if free.any() else ():
                local = _Local(whole, start, free, closed[free], refinement)
                if residuals is None:
                    local.by_cost()
                else:
                    local.by_residuals(_batched(residuals, batch=batch))
                refined += 1
        message = f"refined the best {refined} separated points of {found.nfev} evaluated globally"
    except Halted as end:
        message = str(end)
    result = whole.result(message, refined)
    result["starts"] = box.from_unit(starts)
    return result


def separated(
    unit: Array, values: Array, earlier: Array, refinement: Refinement, free: AxisMask, closed: AxisMask
) -> Array:
    """The best points, each apart from all better ones chosen and from those refined earlier: at most
    refinement.starts with the same held values.

    Held are the coordinates that are not free: every combination of their values is a hypothesis of its own,
    and has its best points refined, however far behind it lies so far.
    """
    taken: dict[bytes, list[Array]] = {}
    for point in earlier:
        taken.setdefault(point[~free].tobytes(), []).append(point)
    most = {held: len(points) + refinement.starts for held, points in taken.items()}
    chosen: list[Array] = []
    for row in np.argsort(values, kind="stable"):
        point = unit[row]
        held = point[~free].tobytes()
        others = taken.setdefault(held, [])
        if np.isfinite(values[row]) and len(others) < most.get(held, refinement.starts):
            gaps = [_gap(point[free], other[free], closed[free]) for other in others]
            if all((gap > refinement.separation).any() for gap in gaps):
                others.append(point)
                chosen.append(point)
    return np.array(chosen).reshape(-1, unit.shape[1])


def _gap(one: Array, other: Array, closed: AxisMask) -> Array:
    """Distance in every coordinate, the shorter way round where it is closed."""
    gap = np.abs(one - other)
    return np.where(closed, np.minimum(gap, 1.0 - gap), gap)


@dataclass(frozen=True, slots=True)
class _Local:
    """A search over the free coordinates from one start; the others keep their values.

    Closed coordinates may run half a turn beyond either bound and are turned back for the objective.
    """

    whole: Evaluations
    start: Array
    free: AxisMask
    closed: AxisMask
    refinement: Refinement

    def by_cost(self) -> None:
        def cost_and_gradient(part: Array) -> tuple[float, Array]:
            ahead = np.where(part + DIFFERENCE > 1.0, -DIFFERENCE, DIFFERENCE)
            values = self.whole(self._points(np.concatenate([part[np.newaxis], part + np.diag(ahead)])))
            return float(values[0]), np.asarray((values[1:] - values[0]) / ahead, dtype=np.float64)

        scipy_minimize(
            cost_and_gradient,
            self.start[self.free],
            method="L-BFGS-B",
            jac=True,
            bounds=self._bounds(),
            options={"ftol": self.refinement.tolerance**2, "gtol": 0.0},
        )

    def by_residuals(self, residuals: Callable[[Array], Array]) -> None:
        def rows(part: Array) -> Array:
            unit = self._points(part)
            found = residuals(self.whole.box.from_unit(unit))
            self.whole.record(unit, np.einsum("mn,mn->m", found, found))
            return found

        least_squares.minimise(
            rows, self._bounds(), start=self.start[self.free], tolerance=self.refinement.tolerance,
            central=False, batch=True,
        )  # fmt: skip

    def _bounds(self) -> list[tuple[float, float]]:
        return [(-0.5, 1.5) if closed else (0.0, 1.0) for closed in self.closed]

    def _points(self, part: Array) -> Array:
        """Points of [0, 1]^d from free coordinates (m, k)."""
        unit = np.repeat(self.start[np.newaxis], len(part), axis=0)
        unit[:, self.free] = np.where(self.closed, part % 1.0, np.clip(part, 0.0, 1.0))
        return unit


def _batched(residuals: least_squares.Residuals, *, batch: bool) -> Callable[[Array], Array]:
    if batch:
        return residuals
    return lambda points: np.array([residuals(point) for point in points], dtype=np.float64)
