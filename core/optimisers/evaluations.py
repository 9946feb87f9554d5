"""Every point an optimiser has evaluated: counted, never evaluated twice, and handed over in the end."""

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np

from core.optimisers.objective import Array, BatchFunction, Box, Callback, OptimiserError

if TYPE_CHECKING:
    from scipy.optimize import OptimizeResult


@dataclass(frozen=True, slots=True)
class SearchResult:
    """What a search came to.

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
    """

    x: Array
    fun: float
    nfev: int
    nit: int
    success: bool
    message: str
    points: Array
    costs: Array

    def as_optimize_result(self) -> "OptimizeResult":
        """Return the same as scipy's type, for callers who compare with scipy's optimisers.

        Returns
        -------
        OptimizeResult
            The result.
        """
        from scipy.optimize import OptimizeResult  # its import takes as long as five diagnoses

        result = OptimizeResult()
        result.update({field.name: getattr(self, field.name) for field in fields(self)})
        return result


class Stopped(Exception):  # noqa: N818 (no error: the way out of a library's search)
    """The signal that the callback asked for the end, or that the budget is spent; its text is the reason."""


class Halted(Exception):  # noqa: N818
    """The same signal for a search made of several: it passes through the one that happens to run."""


class Evaluations:
    """An objective on the unit box that keeps its points and values in the order of evaluation.

    A point evaluated before costs nothing: its value is looked up. Calls raise Stopped (Halted where
    `staged`) once the callback answers true, or where more than `budget` evaluations are asked for (those
    within it are made first).

    Parameters
    ----------
    fun : callable
        The objective, a function of points (m, d) of the box.
    box : Box
        The box that is searched.
    callback : callable or None, optional
        Called with new points (m, d) and their values (m,); a true answer stops the search.
    budget : int or None, optional
        Most evaluations.
    staged : bool, default False
        Whether the search is one of several.
    """

    def __init__(
        self,
        fun: BatchFunction,
        box: Box,
        *,
        callback: Callback | None = None,
        budget: int | None = None,
        staged: bool = False,
    ) -> None:
        self.box = box
        self.count = 0
        self._fun = fun
        self._callback = callback
        self._budget = budget
        self._end = Halted if staged else Stopped
        self._points: list[Array] = []
        self._values: list[Array] = []
        self._known: dict[bytes, float] = {}

    def __call__(self, unit: Array) -> Array:
        """Values (m,) at points (m, d) of [0, 1]^d."""
        # Adding zero turns -0.0 into 0.0, which is the same point but other bytes.
        points = self.box.from_unit(unit) + 0.0
        keys = [point.tobytes() for point in points]
        fresh: dict[bytes, int] = {}
        for row, key in enumerate(keys):
            if key not in self._known and key not in fresh:
                fresh[key] = row
        rows = list(fresh.values())
        allowed = len(rows) if self._budget is None else min(len(rows), self._budget - self.count)
        if allowed:
            self._evaluate(points[rows[:allowed]], list(fresh)[:allowed])
        if allowed < len(rows):
            raise self._end(self._spent)
        return np.array([self._known[key] for key in keys])

    def record(self, unit: Array, values: Array) -> None:
        """Take over points with values that were found elsewhere; they count.

        Parameters
        ----------
        unit : ndarray, shape (m, d)
            Points of the unit box.
        values : ndarray, shape (m,)
            Their values.
        """
        points = self.box.from_unit(unit) + 0.0
        self._keep(points, [point.tobytes() for point in points], values)
        if self._budget is not None and self.count >= self._budget:
            raise self._end(self._spent)

    @property
    def _spent(self) -> str:
        return f"evaluated the most points allowed, {self._budget}"

    def at(self, unit: Array) -> float:
        """Return the value at a single point.

        Parameters
        ----------
        unit : ndarray, shape (d,)
            Point of the unit box.

        Returns
        -------
        float
            Its value.
        """
        return float(self(np.asarray(unit, dtype=np.float64)[np.newaxis])[0])

    @property
    def points(self) -> Array:
        """Points of the box in the order of evaluation, shape (nfev, d)."""
        return np.concatenate(self._points) if self._points else np.empty((0, self.box.dimensions))

    @property
    def values(self) -> Array:
        """Values of the points, shape (nfev,)."""
        return np.concatenate(self._values) if self._values else np.empty(0)

    def best(self) -> Array:
        """Return the best point so far; the middle of the box before the first evaluation.

        Returns
        -------
        ndarray, shape (d,)
            Point of the unit box.
        """
        if not self._values:
            return np.full(self.box.dimensions, 0.5)
        return self.box.to_unit(self.points[int(np.argmin(self.values))])

    def result(self, message: str, steps: int) -> "OptimizeResult":
        """Return the outcome as scipy's type.

        Parameters
        ----------
        message : str
            Why the search ended.
        steps : int
            Number of steps.

        Returns
        -------
        OptimizeResult
            The result.
        """
        return self.outcome(message, steps).as_optimize_result()

    def outcome(self, message: str, steps: int) -> SearchResult:
        """Return what the search has come to.

        Parameters
        ----------
        message : str
            Why the search ended.
        steps : int
            Number of steps.

        Returns
        -------
        SearchResult
            The result.

        Raises
        ------
        OptimiserError
            If nothing was evaluated.
        """
        points, values = self.points, self.values
        if not values.size:
            raise OptimiserError("max_evaluations: expected at least one evaluation, found none left")
        best = int(np.argmin(values))
        return SearchResult(
            x=points[best],
            fun=float(values[best]),
            nfev=len(values),
            nit=steps,
            success=bool(np.isfinite(values[best])),
            message=message,
            points=points,
            costs=values,
        )

    def _evaluate(self, points: Array, keys: list[bytes]) -> None:
        self._keep(points, keys, self._fun(points))

    def _keep(self, points: Array, keys: list[bytes], values: Array) -> None:
        self._known.update(zip(keys, values.tolist(), strict=True))
        self._points.append(points)
        self._values.append(values)
        self.count += len(values)
        if self._callback is not None and self._callback(points, values):
            raise self._end("stopped by the callback")
