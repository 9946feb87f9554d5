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
    """Draw points of the unit box, one in each slice of every coordinate.

    Parameters
    ----------
    count : int
        Number of points, and of slices of each coordinate.
    dimensions : int
        Number of coordinates.
    seed : int
        Seed of the random numbers.

    Returns
    -------
    ndarray, shape (count, dimensions)
        The points.
    """
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
    """Return the best of some Latin hypercube points.

    Parameters
    ----------
    fun : callable
        The objective, a function of one point (d,), or with `batch` of points (m, d).
    bounds : sequence of (float, float)
        Lower and upper bound of each coordinate.
    samples : int, default 60
        Number of points.
    seed : int, default 0
        Seed of the random numbers.
    batch : bool, default False
        Whether `fun` takes points (m, d) at once and returns their values (m,).
    callback : callable or None, optional
        Called with new points (m, d) and their values (m,); a true answer stops the search.

    Returns
    -------
    OptimizeResult
        Fields x, fun, nfev, nit, success, message, points (nfev, d) and costs (nfev,).

    Raises
    ------
    OptimiserError
        If an argument is impossible.
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
