"""The box an optimiser searches, checked once, and the objective evaluated on it in batches."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Bounds = Sequence[tuple[float, float]]
PointFunction = Callable[[Array], float]
BatchFunction = Callable[[Array], Array]


class OptimiserError(ValueError):
    """An optimiser was asked for something impossible; the message names the argument."""


def checked_bounds(bounds: Bounds) -> tuple[Array, Array]:
    """Lower and upper bounds, each of shape (dimensions,).

    Raises OptimiserError unless every pair is finite with lower < upper.
    """
    box = np.asarray(bounds, dtype=np.float64)
    if box.ndim != 2 or box.shape[1:] != (2,) or box.shape[0] == 0:
        raise OptimiserError(
            f"bounds: expected a (lower, upper) pair for each dimension, found shape {box.shape}"
        )
    lower, upper = box.T
    if not (np.isfinite(box).all() and (lower < upper).all() and np.isfinite(upper - lower).all()):
        raise OptimiserError(f"bounds: expected finite pairs with lower < upper, found {box.tolist()}")
    return lower, upper


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
