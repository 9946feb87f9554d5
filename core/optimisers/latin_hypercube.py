"""Latin hypercube sampling: points of which every coordinate is spread evenly (thesis section 6.5.1).

McKay, Beckman and Conover, Technometrics 21 (1979), doi:10.1080/00401706.1979.10489755; the sampler is
scipy's.
"""

from scipy.optimize import OptimizeResult
from scipy.stats.qmc import LatinHypercube

from core.optimisers.evaluations import Evaluations, Stopped
from core.optimisers.objective import (
    Array,
    BatchFunction,
    Bounds,
    Callback,
    PointFunction,
    as_batch,
    checked_bounds,
    checked_count,
)


def unit_points(count: int, dimensions: int, seed: int) -> Array:
    """`count` points of [0, 1]^d, one in each of `count` slices of every coordinate."""
    return LatinHypercube(dimensions, rng=seed).random(count)


def minimise(
    fun: PointFunction | BatchFunction,
    bounds: Bounds,
    *,
    samples: int = 60,
    seed: int = 0,
    batch: bool = False,
    callback: Callback | None = None,
) -> OptimizeResult:
    """The best of `samples` Latin hypercube points.

    Returns x, fun, nfev, nit, success, message, points (nfev, d), costs (nfev,).
    Raises OptimiserError for impossible arguments.
    """
    box = checked_bounds(bounds)
    checked_count("samples", samples, 1)
    evaluations = Evaluations(as_batch(fun, batch=batch), box, callback=callback)
    message = f"evaluated {samples} samples"
    try:
        evaluations(unit_points(samples, box.dimensions, seed))
    except Stopped as stop:
        message = str(stop)
    return evaluations.result(message, 1)
