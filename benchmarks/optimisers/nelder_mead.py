"""Nelder-Mead refinement of a point: scipy's, on the unit box, so that every coordinate counts alike.

Nelder and Mead, Computer J. 7 (1965), doi:10.1093/comjnl/7.4.308; thesis sections 4.4.4 and 5.3.2.
"""

from collections.abc import Sequence

import numpy as np
from scipy.optimize import OptimizeResult
from scipy.optimize import minimize as scipy_minimize

from core.optimisers.evaluations import Evaluations, Stopped
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


def minimise(
    fun: PointFunction | BatchFunction,
    bounds: Bounds,
    *,
    start: Sequence[float] | Array | None = None,
    size: float = 0.05,
    tolerance: float = 1e-6,
    function_tolerance: float = 1e-12,
    max_evaluations: int = 1_000,
    batch: bool = False,
    callback: Callback | None = None,
) -> OptimizeResult:
    """Minimise `fun` over a box from `start` (default: its middle).

    size: edge of the first simplex, a fraction of the box.  tolerance, function_tolerance: stop when the
    simplex is smaller (fraction of the box) and its values differ by less.
    batch: `fun` takes points (m, d); after the first simplex they come one at a time.

    Returns x, fun, nfev, nit, success, message, points (nfev, d), costs (nfev,).
    Raises OptimiserError for impossible arguments.
    """
    box = checked_bounds(bounds)
    checked_count("max_evaluations", max_evaluations, 1)
    if not (0.0 < size <= 0.5 and tolerance > 0.0 and function_tolerance >= 0.0):
        raise OptimiserError(
            "expected size above 0 and up to 0.5, tolerance above 0, function_tolerance at least 0: "
            f"found {size}, {tolerance}, {function_tolerance}"
        )
    corner = box.start(start)
    # Towards the inside: no vertex of the first simplex may fall on another by being put on a face.
    edges = np.diag(np.where(corner > 0.5, -size, size))
    simplex = np.concatenate([corner[np.newaxis], corner + edges])
    evaluations = Evaluations(as_batch(fun, batch=batch), box, callback=callback, budget=max_evaluations)
    try:
        evaluations(simplex)
        found = scipy_minimize(
            evaluations.at,
            corner,
            method="Nelder-Mead",
            bounds=[(0.0, 1.0)] * box.dimensions,
            options={
                "initial_simplex": simplex,
                "xatol": tolerance,
                "fatol": function_tolerance,
                # Looking up a point again is no evaluation: only ours are counted.
                "maxfev": 100 * max_evaluations,
                "maxiter": 100 * max_evaluations,
            },
        )
        message = f"the simplex is smaller than tolerance = {tolerance:g}"
        steps = int(found.nit)
    except Stopped as stop:
        message, steps = str(stop), evaluations.count
    return evaluations.result(message, steps)
