"""Pattern search: a mesh of directions around the best point, widened on success, narrowed on failure.

Thesis section 6.3.1; Torczon, SIAM J. Optim. 7 (1997), doi:10.1137/S1052623493250780. It is a local search:
where it ends depends on where it begins, so it may begin at the best of some Latin hypercube points (6.5.1).
No library at hand has it with both patterns, bounds and batches.
"""

from collections.abc import Sequence
from enum import StrEnum

import numpy as np
from scipy.optimize import OptimizeResult

from core.optimisers.evaluations import Evaluations, Stopped
from core.optimisers.latin_hypercube import unit_points
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


class Pattern(StrEnum):
    """Directions tried: both ways along every axis, or along every axis and once against all of them."""

    TWO_D = "2D"
    D_PLUS_ONE = "D+1"


def minimise(
    fun: PointFunction | BatchFunction,
    bounds: Bounds,
    *,
    start: Sequence[float] | Array | None = None,
    samples: int = 0,
    pattern: Pattern | str = Pattern.TWO_D,
    mesh: float = 0.25,
    mesh_factor: float = 2.0,
    smallest_mesh: float = 1e-6,
    function_tolerance: float = 0.0,
    max_evaluations: int = 2_000,
    seed: int = 0,
    batch: bool = False,
    callback: Callback | None = None,
) -> OptimizeResult:
    """Minimise a function over a box by pattern search (thesis section 6.3.1).

    Points beyond the bounds are not tried.

    Parameters
    ----------
    fun : callable
        The objective, a function of one point (d,), or with `batch` of points (m, d).
    bounds : sequence of (float, float)
        Lower and upper bound of each coordinate.
    start : sequence of float or ndarray or None, optional
        Point to begin at; the middle of the box by default.
    samples : int, default 0
        Number of Latin hypercube points at the best of which it begins instead.
    pattern : Pattern or str, default Pattern.TWO_D
        Directions tried.
    mesh : float, default 0.25
        First step length, a fraction of the box.
    mesh_factor : float, default 2.0
        Factor by which the mesh grows after a success, up to 1, and shrinks after a failure.
    smallest_mesh : float, default 1e-06
        Mesh at which the search ends.
    function_tolerance : float, default 0.0
        The search stops after a success that gained less; 0 leaves the end to the mesh.
    max_evaluations : int, default 2000
        Most evaluations.
    seed : int, default 0
        Seed of the random numbers.
    batch : bool, default False
        Whether `fun` takes points (m, d) at once and returns their values (m,).
    callback : callable or None, optional
        Called with new points (m, d) and their values (m,); a true answer stops the search.

    Returns
    -------
    OptimizeResult
        Fields x, fun, nfev, nit, success, message, points (nfev, d), costs (nfev,) and centres (nit + 1, d).

    Raises
    ------
    OptimiserError
        If an argument is impossible.
    """
    box = checked_bounds(bounds)
    checked_count("max_evaluations", max_evaluations, 1)
    checked_count("samples", samples, 0)
    if start is not None and samples:
        raise OptimiserError("start, samples: expected one of them, found both")
    if not (0.0 < smallest_mesh <= mesh <= 1.0 and mesh_factor > 1.0 and function_tolerance >= 0.0):
        raise OptimiserError(
            "expected 0 < smallest_mesh <= mesh <= 1, mesh_factor > 1, function_tolerance >= 0: "
            f"found {smallest_mesh}, {mesh}, {mesh_factor}, {function_tolerance}"
        )
    directions = _directions(Pattern(pattern), box.dimensions)
    evaluations = Evaluations(as_batch(fun, batch=batch), box, callback=callback, budget=max_evaluations)
    centres: list[Array] = []
    try:
        if samples:
            evaluations(unit_points(samples, box.dimensions, seed))
            centre = evaluations.best()
        else:
            centre = box.start(start)
        value = evaluations.at(centre)
        centres.append(centre)
        while True:
            around = centre + mesh * directions
            around = around[((around >= 0.0) & (around <= 1.0)).all(axis=1)]
            values = evaluations(around) if len(around) else np.empty(0)
            best = int(np.argmin(values)) if values.size else 0
            if values.size and values[best] < value:
                gain = value - values[best]
                centre, value = around[best], float(values[best])
                mesh = min(1.0, mesh * mesh_factor)
                if gain < function_tolerance:
                    message = f"a step gained less than function_tolerance = {function_tolerance:g}"
                    break
            else:
                mesh /= mesh_factor
                if mesh < smallest_mesh:
                    message = f"the mesh is narrower than smallest_mesh = {smallest_mesh:g}"
                    break
            centres.append(centre)
    except Stopped as stop:
        message = str(stop)
    result = evaluations.result(message, max(0, len(centres) - 1))
    result["centres"] = box.from_unit(np.array(centres).reshape(-1, box.dimensions))
    return result


def _directions(pattern: Pattern, dimensions: int) -> Array:
    axes = np.eye(dimensions)
    against = -axes if pattern is Pattern.TWO_D else -np.ones((1, dimensions))
    return np.concatenate([axes, against])
