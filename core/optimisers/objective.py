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
    """The error of an optimiser that is asked for something impossible; it names the argument."""


@dataclass(frozen=True, slots=True)
class Box:
    """Lower and upper bounds; optimisers work on the unit box.

    Parameters
    ----------
    lower, upper : ndarray, shape (dimensions,)
        Bounds of each coordinate.
    """

    lower: Array
    upper: Array

    @property
    def dimensions(self) -> int:
        """Number of coordinates."""
        return self.lower.size

    def from_unit(self, unit: Array) -> Array:
        """Map points of the unit box to points of the box, never beyond its bounds.

        Parameters
        ----------
        unit : ndarray, shape (m, d)
            Points of the unit box.

        Returns
        -------
        ndarray, shape (m, d)
            Points of the box.
        """
        points = self.lower + unit * (self.upper - self.lower)
        return np.asarray(np.clip(points, self.lower, self.upper), dtype=np.float64)

    def to_unit(self, points: Array) -> Array:
        """Map points of the box to points of the unit box; what lies outside is put on its face.

        Parameters
        ----------
        points : ndarray, shape (m, d)
            Points of the box.

        Returns
        -------
        ndarray, shape (m, d)
            Points of the unit box.
        """
        unit = (points - self.lower) / (self.upper - self.lower)
        return np.asarray(np.clip(unit, 0.0, 1.0), dtype=np.float64)

    def start(self, point: Sequence[float] | Array | None, name: str = "start") -> Array:
        """Check a starting point and map it to the unit box; the middle for None.

        Parameters
        ----------
        point : sequence of float or ndarray or None
            Point of the box.
        name : str, default 'start'
            Name of the argument, for the message.

        Returns
        -------
        ndarray, shape (d,)
            Point of the unit box.

        Raises
        ------
        OptimiserError
            If the point is not finite, of another dimension or outside the box.
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
    """Check bounds and return the box they make.

    Parameters
    ----------
    bounds : sequence of (float, float)
        Lower and upper bound of each coordinate.

    Returns
    -------
    Box
        The box.

    Raises
    ------
    OptimiserError
        If a pair is not finite with lower < upper.
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
    """Check a whole number against its least value and return it.

    Parameters
    ----------
    name : str
        Name of the argument, for the message.
    value : int
        The number.
    least : int
        Least value.

    Returns
    -------
    int
        The number.

    Raises
    ------
    OptimiserError
        If it is less.
    """
    if value < least:
        raise OptimiserError(f"{name}: expected at least {least}, found {value}")
    return value


def as_batch(fun: PointFunction | BatchFunction, *, batch: bool) -> BatchFunction:
    """Return the objective as a function of points (m, d); NaN counts as infinitely bad.

    Parameters
    ----------
    fun : callable
        The objective, a function of one point (d,), or with `batch` of points (m, d).
    batch : bool
        Whether `fun` takes points (m, d) at once and returns their values (m,).

    Returns
    -------
    callable
        The batch function.
    """

    def evaluate(points: Array) -> Array:
        raw = fun(points) if batch else [fun(point) for point in points]
        values = np.asarray(raw, dtype=np.float64)
        if values.shape != (len(points),):
            raise OptimiserError(
                f"fun: expected {len(points)} values for {len(points)} points, found {values.shape}"
            )
        return np.where(np.isnan(values), np.inf, values)

    return evaluate
