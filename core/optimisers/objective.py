"""The box an optimiser searches, checked once, and the objective evaluated on it in batches."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Bounds = Sequence[tuple[float, float]]
PointFunction = Callable[[Array], float]
BatchFunction = Callable[[Array], Array]
Callback = Callable[[Array, Array], bool | None]
"""Called with new points (m, d) and their values (m,); a true answer stops the search."""


class OptimiserError(ValueError):
    """An optimiser was asked for something impossible; the message names the argument."""


@dataclass(frozen=True, slots=True)
class Box:
    """Lower and upper bounds, each of shape (dimensions,). Optimisers work on the unit box."""

    lower: Array
    upper: Array

    @property
    def dimensions(self) -> int:
        return self.lower.size

    def from_unit(self, unit: Array) -> Array:
        """Points of the box from points of [0, 1]^d, never beyond its bounds."""
        points = self.lower + unit * (self.upper - self.lower)
        return np.asarray(np.clip(points, self.lower, self.upper), dtype=np.float64)

    def to_unit(self, points: Array) -> Array:
        """Points of [0, 1]^d from points of the box; what lies outside is put on its face."""
        unit = (points - self.lower) / (self.upper - self.lower)
        return np.asarray(np.clip(unit, 0.0, 1.0), dtype=np.float64)

    def start(self, point: Sequence[float] | Array | None, name: str = "start") -> Array:
        """A starting point in [0, 1]^d; the middle for None.

        Raises OptimiserError unless the point is finite, of the box's dimension and inside it.
        """
        if point is None:
            return np.full(self.dimensions, 0.5)
        given = np.asarray(point, dtype=np.float64)
        inside = given.shape == self.lower.shape and bool(
            ((given >= self.lower) & (given <= self.upper)).all()
        )
        if not inside:
            raise OptimiserError(
                f"{name}: expected {self.dimensions} coordinates inside the bounds, found {given.tolist()}"
            )
        return self.to_unit(given)


def checked_bounds(bounds: Bounds) -> Box:
    """The box of (lower, upper) pairs.

    Raises OptimiserError unless every pair is finite with lower < upper.
    """
    pairs = np.asarray(bounds, dtype=np.float64)
    if pairs.ndim != 2 or pairs.shape[1:] != (2,) or pairs.shape[0] == 0:
        raise OptimiserError(
            f"bounds: expected a (lower, upper) pair for each dimension, found shape {pairs.shape}"
        )
    lower, upper = np.ascontiguousarray(pairs.T)
    with np.errstate(over="ignore"):
        finite = bool(np.isfinite(pairs).all() and np.isfinite(upper - lower).all())
    if not (finite and (lower < upper).all()):
        raise OptimiserError(f"bounds: expected finite pairs with lower < upper, found {pairs.tolist()}")
    return Box(lower, upper)


def checked_count(name: str, value: int, least: int) -> int:
    """A whole number of at least `least`; raises OptimiserError otherwise."""
    if value < least:
        raise OptimiserError(f"{name}: expected at least {least}, found {value}")
    return value


def as_batch(fun: PointFunction | BatchFunction, *, batch: bool) -> BatchFunction:
    """The objective as a function of points (m, d) giving values (m,); NaN counts as infinitely bad."""

    def evaluate(points: Array) -> Array:
        raw = fun(points) if batch else [fun(point) for point in points]
        values = np.asarray(raw, dtype=np.float64)
        if values.shape != (len(points),):
            raise OptimiserError(
                f"fun: expected {len(points)} values for {len(points)} points, found {values.shape}"
            )
        return np.where(np.isnan(values), np.inf, values)

    return evaluate
