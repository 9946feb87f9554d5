"""The Hyperbolic Cross Point Algorithm: global search on a sparse grid (thesis chapter 4).

Novak and Ritter, "Global optimization using hyperbolic cross points", in State of the Art in Global
Optimization, Kluwer 1996. Points have dyadic coordinates in [-0.5, 0.5]; a coordinate's level is the number
of its binary digits (4.3), a point's level the sum over its coordinates (4.4). Each step expands the point
with the least

    G = (L + D)^alpha R^(1 - alpha)                                                                (4.5)

(level L, degree D = how often it was expanded, rank R of its value among all) into its neighbours, which
differ in one coordinate by 2^-(level of that coordinate + D) (4.6).
"""

from bisect import bisect_left, insort
from collections.abc import Callable, Sequence
from heapq import heappop, heappush

import numpy as np
from scipy.optimize import OptimizeResult

from core.optimisers.objective import (
    Array,
    BatchFunction,
    Bounds,
    OptimiserError,
    PointFunction,
    as_batch,
    checked_bounds,
)

RECOMMENDED = {
    1: (14, 0.02, 0.5),
    2: (14, 0.02, 0.5),
    3: (7, 0.05, 0.4),
    4: (5, 0.08, 0.2),
    5: (4, 0.15, 0.15),
}
"""Fineness L0, exclusion epsilon and adaptiveness alpha by dimension (Table 4.1)."""
RECOMMENDED_BEYOND = (3, 0.3, 0.1)

DIGITS = 52
"""Binary digits of a coordinate; also its deepest level, as many as a double can hold."""
HALF = 1 << (DIGITS - 1)

Callback = Callable[[Array, Array], bool | None]


def minimise(
    fun: PointFunction | BatchFunction,
    bounds: Bounds,
    *,
    adaptiveness: float | None = None,
    fineness: int | None = None,
    exclusion: float | None = None,
    max_global: int = 500,
    max_local: int = 500,
    allowed: Sequence[Sequence[float] | None] | None = None,
    batch: bool = False,
    callback: Callback | None = None,
) -> OptimizeResult:
    """Minimise `fun` over a box.

    adaptiveness: alpha in [0, 1]; 0 prefers good values (local), 1 unexplored regions (global).
    fineness: L0; only points of a level below it are evaluated.
    exclusion: side (fraction of the box) of the region around an exhausted point that is searched no more.
    max_global, max_local: evaluations with the given alpha, then with alpha = 0 (Fig. 4.7).
    allowed: for each coordinate the only values it may take, or None ("improved HCPA", section 6.4.3).
    batch: `fun` takes points (m, d) and returns (m,) values; a step hands over all its neighbours at once.
    callback: called with the points and values of each step; a true answer stops the search.

    Returns x, fun, nfev, nit, success, message, and every point in order of evaluation: points (nfev, d),
    costs (nfev,), levels (nfev,). Arguments left None take Table 4.1's value for the dimension.
    Raises OptimiserError for impossible arguments.
    """
    lower, upper = checked_bounds(bounds)
    dimensions = lower.size
    table = RECOMMENDED.get(dimensions, RECOMMENDED_BEYOND)
    fineness = table[0] if fineness is None else fineness
    exclusion = table[1] if exclusion is None else exclusion
    adaptiveness = table[2] if adaptiveness is None else adaptiveness
    if not 0.0 <= adaptiveness <= 1.0:
        raise OptimiserError(f"adaptiveness: expected 0 to 1, found {adaptiveness}")
    if fineness < 1 or exclusion < 0.0 or max_global < 1 or max_local < 0:
        raise OptimiserError(
            "fineness and max_global must be at least 1, exclusion and max_local at least 0: "
            f"found {fineness}, {max_global}, {exclusion}, {max_local}"
        )
    search = _Search(lower, upper, fineness, exclusion, _admitted(allowed, lower, upper))
    return search.run(as_batch(fun, batch=batch), adaptiveness, max_global, max_local, callback)


def level(digits: int) -> int:
    """Level of a coordinate given as an integer multiple of 2^-DIGITS (4.3); 0 for the coordinate 0."""
    return DIGITS - ((digits & -digits).bit_length() - 1) if digits else 0


def _admitted(
    allowed: Sequence[Sequence[float] | None] | None, lower: Array, upper: Array
) -> list[frozenset[int] | None]:
    if allowed is None:
        return [None] * lower.size
    if len(allowed) != lower.size:
        raise OptimiserError(
            f"allowed: expected one entry for each of {lower.size} dimensions, found {len(allowed)}"
        )
    admitted: list[frozenset[int] | None] = []
    for axis, values in enumerate(allowed):
        if values is None:
            admitted.append(None)
            continue
        scaled = ((np.asarray(values) - lower[axis]) / (upper[axis] - lower[axis]) - 0.5) * 2.0**DIGITS
        digits = frozenset(round(value) for value in scaled)
        if not digits or 0 not in digits or max(abs(value) for value in digits) > HALF:
            raise OptimiserError(
                f"allowed[{axis}]: expected values inside the bounds, the middle of the box among them "
                f"(the search starts there), found {list(values)}"
            )
        admitted.append(digits)
    return admitted


class _Search:
    """Points found so far and the order in which they are to be expanded.

    Among points of one L + D the least G belongs to the least value, so one heap for each L + D holds them
    all and a step only compares the heads; the rank of a head is its place in the sorted list of values.
    """

    def __init__(
        self,
        lower: Array,
        upper: Array,
        fineness: int,
        exclusion: float,
        admitted: list[frozenset[int] | None],
    ) -> None:
        self._lower, self._span = lower, upper - lower
        self._fineness = fineness
        self._exclusion = exclusion * 2.0 ** (DIGITS - 1)
        self._admitted = admitted
        self._points: list[tuple[int, ...]] = []
        self._seen: set[tuple[int, ...]] = set()
        self._levels: list[int] = []
        self._degrees: list[int] = []
        self._values: list[float] = []
        self._sorted: list[float] = []
        self._heaps: dict[int, list[tuple[float, int]]] = {}
        self._minima: list[tuple[int, ...]] = []

    def run(
        self,
        fun: BatchFunction,
        adaptiveness: float,
        max_global: int,
        max_local: int,
        callback: Callback | None,
    ) -> OptimizeResult:
        stopped = self._evaluate(fun, [(0,) * self._lower.size], callback)
        steps = 0
        message = "stopped by the callback"
        while not stopped:
            if len(self._values) >= max_global + max_local:
                message = f"evaluated max_global + max_local = {max_global + max_local} points"
                break
            alpha = adaptiveness if len(self._values) < max_global else 0.0
            best = self._least_goodness(alpha)
            if best is None:
                message = f"every reachable point of a level below {self._fineness} is evaluated"
                break
            budget = max_global + max_local - len(self._values)
            stopped = self._evaluate(fun, self._expand(best)[:budget], callback)
            steps += 1
        return self._result(steps, message)

    def _least_goodness(self, alpha: float) -> int | None:
        best, least = None, np.inf
        for generation, heap in self._heaps.items():
            if heap:
                rank = bisect_left(self._sorted, heap[0][0]) + 1
                goodness = max(generation, 1) ** alpha * rank ** (1.0 - alpha)
                if goodness < least:
                    best, least = generation, goodness
        return None if best is None else heappop(self._heaps[best])[1]

    def _expand(self, index: int) -> list[tuple[int, ...]]:
        self._degrees[index] += 1
        degree, point = self._degrees[index], self._points[index]
        generation = self._levels[index] + degree
        if generation >= self._fineness:
            # No neighbour of this point is left above the grid's fineness: it is a minimum of this grid.
            if self._exclusion > 0.0 and not self._is_excluded(point):
                self._minima.append(point)
            return []
        self._push(index)
        return [new for new in self._neighbours(point, degree) if self._is_new(new)]

    def _neighbours(self, point: tuple[int, ...], degree: int) -> list[tuple[int, ...]]:
        found = []
        for axis, digits in enumerate(point):
            depth = level(digits) + degree
            if depth > DIGITS:
                continue
            step = 1 << (DIGITS - depth)
            admitted = self._admitted[axis]
            for moved in (digits - step, digits + step):
                if abs(moved) <= HALF and (admitted is None or moved in admitted):
                    found.append((*point[:axis], moved, *point[axis + 1 :]))
        return found

    def _is_new(self, point: tuple[int, ...]) -> bool:
        return point not in self._seen and not self._is_excluded(point)

    def _is_excluded(self, point: tuple[int, ...]) -> bool:
        return any(
            all(abs(a - b) < self._exclusion for a, b in zip(point, minimum, strict=True))
            for minimum in self._minima
        )

    def _evaluate(self, fun: BatchFunction, new: list[tuple[int, ...]], callback: Callback | None) -> bool:
        if not new:
            return False
        points = self._in_box(new)
        values = fun(points)
        for point, value in zip(new, values.tolist(), strict=True):
            self._seen.add(point)
            self._points.append(point)
            self._levels.append(sum(level(digits) for digits in point))
            self._degrees.append(0)
            self._values.append(value)
            insort(self._sorted, value)
            self._push(len(self._values) - 1)
        return bool(callback(points, values)) if callback is not None else False

    def _push(self, index: int) -> None:
        generation = self._levels[index] + self._degrees[index]
        heappush(self._heaps.setdefault(generation, []), (self._values[index], index))

    def _in_box(self, points: list[tuple[int, ...]]) -> Array:
        unit = np.array(points, dtype=np.float64) * 2.0**-DIGITS + 0.5
        return self._lower + unit * self._span

    def _result(self, steps: int, message: str) -> OptimizeResult:
        values = np.array(self._values)
        best = int(np.argmin(values))
        points = self._in_box(self._points)
        result = OptimizeResult()
        result.update(
            {
                "x": points[best],
                "fun": float(values[best]),
                "nfev": len(values),
                "nit": steps,
                "success": bool(np.isfinite(values[best])),
                "message": message,
                "points": points,
                "costs": values,
                "levels": np.array(self._levels),
            }
        )
        return result
