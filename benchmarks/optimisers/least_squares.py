"""Bounded least squares: scipy's trust-region reflective algorithm on the unit box, in batches.

Branch, Coleman and Li, SIAM J. Sci. Comput. 21 (1999), doi:10.1137/S1064827595289108. The Jacobian comes from
differences, all rows of it one batch.
"""

from collections.abc import Callable, Sequence

import numpy as np
from scipy.optimize import OptimizeResult
from scipy.optimize import least_squares as scipy_least_squares

from core.optimisers.evaluations import Evaluations, Stopped
from core.optimisers.objective import (
    Array,
    Bounds,
    Callback,
    OptimiserError,
    checked_bounds,
    checked_count,
)

Residuals = Callable[[Array], Array]
"""Residuals (n,) of a point (d,); with batch=True (m, n) of points (m, d)."""


def minimise(
    fun: Residuals,
    bounds: Bounds,
    *,
    start: Sequence[float] | Array | None = None,
    difference: float = 1e-4,
    central: bool = True,
    tolerance: float = 1e-8,
    max_evaluations: int = 1_000,
    batch: bool = False,
    callback: Callback | None = None,
) -> OptimizeResult:
    """Minimise the sum of the squared residuals `fun` over a box from `start` (default: its middle).

    difference: step of the difference quotients, a fraction of the box.  central: 2 d evaluations a Jacobian
    and a second-order error instead of d and a first-order one.
    tolerance: stop when a step, a gain or the gradient is smaller (relative; scipy's xtol, ftol, gtol).

    Returns x, fun (the sum), nfev, nit, success, message, points (nfev, d), costs (nfev,).
    Raises OptimiserError for impossible arguments.
    """
    box = checked_bounds(bounds)
    checked_count("max_evaluations", max_evaluations, 1)
    if not (0.0 < difference < 0.5 and tolerance > 0.0):
        raise OptimiserError(
            f"expected difference above 0 and below 0.5, tolerance above 0: found {difference}, {tolerance}"
        )
    residuals = _Residuals(fun, batch=batch)
    evaluations = Evaluations(residuals.costs, box, callback=callback, budget=max_evaluations)

    def residual(unit: Array) -> Array:
        return np.asarray(residuals.of(evaluations, unit[np.newaxis])[0], dtype=np.float64)

    def jacobian(unit: Array) -> Array:
        # Forwards, or backwards where there is no room; central where there is room both ways.
        inwards = np.where(unit + difference > 1.0, -difference, difference)
        ahead = unit + np.diag(inwards)
        behind = np.repeat(unit[np.newaxis], unit.size, axis=0)
        if central:
            behind = np.clip(unit - np.diag(inwards), 0.0, 1.0)
        rows = residuals.of(evaluations, np.concatenate([ahead, behind]))
        width = np.diagonal(ahead - behind)
        quotients = (rows[: unit.size] - rows[unit.size :]) / width[:, np.newaxis]
        return np.asarray(quotients.T, dtype=np.float64)

    steps = 0
    try:
        found = scipy_least_squares(
            residual,
            box.start(start),
            jacobian,
            bounds=(np.zeros(box.dimensions), np.ones(box.dimensions)),
            xtol=tolerance,
            ftol=tolerance,
            gtol=tolerance,
            max_nfev=max_evaluations,
        )
        steps = int(found.njev or 0)
        message = {
            1: f"the gradient is smaller than tolerance = {tolerance:g}",
            2: f"a step gained less than tolerance = {tolerance:g}",
            3: f"a step was shorter than tolerance = {tolerance:g}",
            4: f"a step gained less and was shorter than tolerance = {tolerance:g}",
        }.get(int(found.status), f"evaluated the most points allowed, {max_evaluations}")
    except Stopped as stop:
        message = str(stop)
    return evaluations.result(message, steps)


class _Residuals:
    """Residuals beside their sums of squares: those of the points that the search may still ask for."""

    def __init__(self, fun: Residuals, *, batch: bool) -> None:
        self._fun = fun
        self._batch = batch
        self._held: dict[bytes, Array] = {}

    def costs(self, points: Array) -> Array:
        raw = self._fun(points) if self._batch else [self._fun(point) for point in points]
        rows = np.asarray(raw, dtype=np.float64)
        if rows.ndim != 2 or len(rows) != len(points):
            raise OptimiserError(
                f"fun: expected residuals ({len(points)}, n) for {len(points)} points, found {rows.shape}"
            )
        if not np.isfinite(rows).all():
            raise OptimiserError("fun: expected finite residuals, found NaN or infinity")
        self._held.update((point.tobytes(), row) for point, row in zip(points, rows, strict=True))
        return np.asarray(np.einsum("mn,mn->m", rows, rows), dtype=np.float64)

    def of(self, evaluations: Evaluations, unit: Array) -> Array:
        """Residuals (m, n) at points (m, d) of [0, 1]^d."""
        evaluations(unit)
        points = evaluations.box.from_unit(unit) + 0.0
        return np.array([self._held[point.tobytes()] for point in points])
