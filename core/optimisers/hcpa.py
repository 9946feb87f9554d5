"""The Hyperbolic Cross Point Algorithm: global search on a sparse grid (thesis chapter 4).

Novak and Ritter, "Global optimization using hyperbolic cross points", in State of the Art in Global
Optimization, Kluwer 1996. Points have dyadic coordinates in [-0.5, 0.5]; a coordinate's level is the number
of its binary digits (4.3), a point's level the sum over its coordinates (4.4). Each step expands the point
with the least

    G = (L + D)^alpha R^(1 - alpha)                                                                (4.5)

(level L, degree D = how often it was expanded, rank R of its value among all) into its neighbours, which
differ in one coordinate by 2^-(level of that coordinate + D) (4.6).
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from heapq import heappop, heappush
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from sortedcontainers import SortedList

from core.optimisers.evaluations import Evaluations, SearchResult, Stopped
from core.optimisers.exclusion import Exclusion
from core.optimisers.objective import (
    BatchFunction,
    Bounds,
    Box,
    Callback,
    OptimiserError,
    PointFunction,
    as_batch,
    checked_bounds,
)

if TYPE_CHECKING:
    from scipy.optimize import OptimizeResult

RECOMMENDED = {
    1: (14, 0.02, 0.5),
    2: (14, 0.02, 0.5),
    3: (7, 0.05, 0.4),
    4: (5, 0.08, 0.2),
    5: (4, 0.15, 0.15),
}
"""Fineness L0, exclusion epsilon and adaptiveness alpha by dimension (Table 4.1; 1 is as 2)."""
RECOMMENDED_BEYOND = (3, 0.3, 0.1)

DIGITS = 52
"""Binary digits of a coordinate; also its deepest level, as many as a double can hold."""
HALF = 1 << (DIGITS - 1)

Point = tuple[int, ...]
"""Coordinates as whole multiples of 2^-DIGITS."""


@dataclass(frozen=True, slots=True)
class HcpaSettings:
    """How a search goes about it; see `minimise` for what each setting means.

    It raises OptimiserError for impossible values.

    Parameters
    ----------
    adaptiveness : float
        Preference for unexplored regions, 0 to 1.
    fineness : int
        Only points of a level below it are evaluated.
    exclusion : float, default 0.0
        Side of the region around a local minimum that is searched no more, a fraction of the box.
    max_global, max_local : int, default 500
        Evaluations with this adaptiveness, then with 0.
    allowed : sequence of Sequence[float] | None or None, optional
        For each coordinate the only values it may take, or None.
    """

    adaptiveness: float
    fineness: int
    exclusion: float = 0.0
    max_global: int = 500
    max_local: int = 500
    allowed: Sequence[Sequence[float] | None] | None = None

    def __post_init__(self) -> None:
        if not 0.0 <= self.adaptiveness <= 1.0:
            raise OptimiserError(f"adaptiveness: expected 0 to 1, found {self.adaptiveness}")
        if self.fineness < 1 or self.exclusion < 0.0 or self.max_global < 1 or self.max_local < 0:
            raise OptimiserError(
                "fineness and max_global must be at least 1, exclusion and max_local at least 0: "
                f"found {self.fineness}, {self.max_global}, {self.exclusion}, {self.max_local}"
            )


@dataclass(frozen=True, slots=True)
class HcpaResult(SearchResult):
    """What a search came to, with the level of each point.

    Parameters
    ----------
    x : ndarray, shape (d,)
        The best point.
    fun : float
        Its value.
    nfev, nit : int
        Numbers of evaluations and of steps.
    success : bool
        Whether the best value is finite.
    message : str
        Why the search ended.
    points : ndarray, shape (nfev, d)
        Every point, in the order of evaluation.
    costs : ndarray, shape (nfev,)
        Their values.
    levels : ndarray of int, shape (nfev,)
        Level of each point on the sparse grid.
    """

    levels: NDArray[np.int64]


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
) -> "OptimizeResult":
    """Minimise a function over a box with the Hyperbolic Cross Point Algorithm (thesis chapter 4).

    There is no chance in it: the same arguments take the same path. Arguments left None take Table 4.1's
    value for the dimension.

    Parameters
    ----------
    fun : callable
        The objective, a function of one point (d,), or with `batch` of points (m, d).
    bounds : sequence of (float, float)
        Lower and upper bound of each coordinate.
    adaptiveness : float or None, optional
        Alpha in [0, 1]; 0 prefers good values (local), 1 unexplored regions (global).
    fineness : int or None, optional
        L0; only points of a level below it are evaluated.
    exclusion : float or None, optional
        Side of the region around a local minimum of the grid that is searched no more, a fraction of the box.
        A point is one when it has no neighbours left and none of them has a lower value.
    max_global, max_local : int, default 500
        Evaluations with the given alpha, then with alpha = 0 (Fig. 4.7).
    allowed : sequence of Sequence[float] | None or None, optional
        For each coordinate the only values it may take, or None ("improved HCPA", section 6.4.3).
    batch : bool, default False
        Whether `fun` takes points (m, d) at once and returns their values (m,).
    callback : callable or None, optional
        Called with new points (m, d) and their values (m,); a true answer stops the search.

    Returns
    -------
    OptimizeResult
        Fields x, fun, nfev, nit, success, message, and of every point in order of evaluation points (nfev,
        d), costs (nfev,) and levels (nfev,).

    Raises
    ------
    OptimiserError
        If an argument is impossible.
    """
    box = checked_bounds(bounds)
    table = RECOMMENDED.get(box.dimensions, RECOMMENDED_BEYOND)
    settings = HcpaSettings(
        fineness=table[0] if fineness is None else fineness,
        exclusion=table[1] if exclusion is None else exclusion,
        adaptiveness=table[2] if adaptiveness is None else adaptiveness,
        max_global=max_global,
        max_local=max_local,
        allowed=allowed,
    )
    return search(as_batch(fun, batch=batch), bounds, settings, callback=callback).as_optimize_result()


def search(
    fun: BatchFunction, bounds: Bounds, settings: HcpaSettings, *, callback: Callback | None = None
) -> HcpaResult:
    """Run the same search on a batch function, with its result as a plain dataclass.

    Parameters
    ----------
    fun : callable
        The objective, a function of one point (d,), or with `batch` of points (m, d).
    bounds : sequence of (float, float)
        Lower and upper bound of each coordinate.
    settings : HcpaSettings
        How the search goes about it.
    callback : callable or None, optional
        Called with new points (m, d) and their values (m,); a true answer stops the search.

    Returns
    -------
    HcpaResult
        What the search came to, with the level of each point.

    Raises
    ------
    OptimiserError
        If the bounds are impossible.
    """
    box = checked_bounds(bounds)
    evaluations = Evaluations(fun, box, callback=callback)
    grid = _Search(evaluations, settings.fineness, settings.exclusion, _admitted(settings.allowed, box))
    return grid.run(settings.adaptiveness, settings.max_global, settings.max_local)


def level(digits: int) -> int:
    """Return the level of a coordinate (4.3); it is 0 for the coordinate 0.

    Parameters
    ----------
    digits : int
        Coordinate as an integer multiple of 2^-DIGITS.

    Returns
    -------
    int
        The level.
    """
    return DIGITS - ((digits & -digits).bit_length() - 1) if digits else 0


def deepest_levels(box: Box) -> list[int]:
    """Return for each coordinate the level down to which neighbouring points are different doubles.

    Parameters
    ----------
    box : Box
        The box that is searched.

    Returns
    -------
    list of int
        Levels, one a coordinate.
    """
    coarsest = np.spacing(np.maximum(np.abs(box.lower), np.abs(box.upper)))
    depths = np.floor(np.log2(box.upper - box.lower) - np.log2(coarsest)) - 1.0
    return [int(depth) for depth in np.clip(depths, 0, DIGITS)]


def _admitted(allowed: Sequence[Sequence[float] | None] | None, box: Box) -> list[frozenset[int] | None]:
    if allowed is None:
        return [None] * box.dimensions
    if len(allowed) != box.dimensions:
        raise OptimiserError(
            f"allowed: expected one entry for each of {box.dimensions} dimensions, found {len(allowed)}"
        )
    admitted: list[frozenset[int] | None] = []
    for axis, values in enumerate(allowed):
        if values is None:
            admitted.append(None)
            continue
        span = box.upper[axis] - box.lower[axis]
        scaled = ((np.asarray(values) - box.lower[axis]) / span - 0.5) * 2.0**DIGITS
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
    There are at most L0 heaps, whatever the number of points.
    """

    def __init__(
        self,
        evaluations: Evaluations,
        fineness: int,
        exclusion: float,
        admitted: list[frozenset[int] | None],
    ) -> None:
        self._evaluations = evaluations
        self._admitted = admitted
        self._deepest = deepest_levels(evaluations.box)
        self._fineness = min(fineness, sum(self._deepest) + 1)
        self._exclusion = Exclusion(evaluations.box.dimensions, exclusion * HALF) if exclusion else None
        self._value_of: dict[Point, float] = {}
        self._points: list[Point] = []
        self._levels: list[int] = []
        self._degrees: list[int] = []
        self._sorted = SortedList()
        self._heaps: list[list[tuple[float, int]]] = [[] for _ in range(self._fineness)]

    def run(self, adaptiveness: float, max_global: int, max_local: int) -> HcpaResult:
        """Run the search with the stop logic of Fig. 4.7."""
        budget = max_global + max_local
        steps = 0
        try:
            self._evaluate([(0,) * len(self._admitted)], 0)
            message = f"evaluated max_global + max_local = {budget} points"
            while len(self._points) < budget:
                best = self._least_goodness(adaptiveness if len(self._points) < max_global else 0.0)
                if best is None:
                    message = f"every reachable point of a level below {self._fineness} is evaluated"
                    break
                new, its_level = self._expand(best)
                self._evaluate(new[: budget - len(self._points)], its_level)
                steps += 1
        except Stopped as stop:
            message = str(stop)
        outcome = self._evaluations.outcome(message, steps)
        found = {field.name: getattr(outcome, field.name) for field in fields(outcome)}
        return HcpaResult(**found, levels=np.array(self._levels))

    def _least_goodness(self, alpha: float) -> int | None:
        best, least, lowest = None, np.inf, None
        for generation, heap in enumerate(self._heaps):
            # No better a value at a greater L + D: no less a G, so its rank need not be known.
            if heap and (lowest is None or heap[0][0] < lowest):
                lowest = heap[0][0]
                rank = self._sorted.bisect_left(lowest) + 1
                goodness = max(generation, 1) ** alpha * rank ** (1.0 - alpha)
                if goodness < least:
                    best, least = heap, goodness
        return None if best is None else heappop(best)[1]

    def _expand(self, index: int) -> tuple[list[Point], int]:
        """Return new neighbours of a point and their level, L + D (4.6); none where that reaches L0."""
        self._degrees[index] += 1
        degree, point = self._degrees[index], self._points[index]
        generation = self._levels[index] + degree
        if generation >= self._fineness:
            if self._exclusion is not None and self._is_minimum(point, degree):
                self._exclusion.add(point)
            return [], generation
        self._push(index)
        around = [one for one in self._neighbours(point, degree) if one not in self._value_of]
        if self._exclusion is not None:
            around = self._exclusion.outside(point, around)
        return around, generation

    def _neighbours(self, point: Point, degree: int) -> list[Point]:
        found = []
        for axis, digits in enumerate(point):
            depth = level(digits) + degree
            if depth > self._deepest[axis]:
                continue
            step = 1 << (DIGITS - depth)
            admitted = self._admitted[axis]
            for moved in (digits - step, digits + step):
                if -HALF <= moved <= HALF and (admitted is None or moved in admitted):
                    found.append((*point[:axis], moved, *point[axis + 1 :]))
        return found

    def _is_minimum(self, point: Point, degrees: int) -> bool:
        """Whether no evaluated neighbour is lower; those of degree 0 are the points it descends from."""
        value = self._value_of[point]
        return all(
            self._value_of.get(one, np.inf) >= value
            for degree in range(degrees)
            for one in self._neighbours(point, degree)
        )

    def _evaluate(self, new: list[Point], its_level: int) -> None:
        if not new:
            return
        # Levels first: a callback that stops the search leaves points whose levels are asked for too.
        self._levels += [its_level] * len(new)
        self._degrees += [0] * len(new)
        first = len(self._points)
        self._points += new
        values = self._evaluations(np.array(new, dtype=np.float64) * 2.0**-DIGITS + 0.5).tolist()
        self._value_of.update(zip(new, values, strict=True))
        self._sorted.update(values)
        for index, value in enumerate(values, start=first):
            heappush(self._heaps[its_level], (value, index))

    def _push(self, index: int) -> None:
        generation = self._levels[index] + self._degrees[index]
        value = self._value_of[self._points[index]]
        heappush(self._heaps[generation], (value, index))
