"""Global search on one start: the Hyperbolic Cross Point Algorithm over the seven unknowns (thesis 5.3, 5.4).

The switching flux is no eighth and ninth: it follows from the instant seen in the currents, near enough.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import log

import numpy as np
from scipy.optimize import OptimizeResult

from core.commissioning.fit import Records
from core.commissioning.prior import PARAMETERS
from core.commissioning.start import Start
from core.machines.base import Array
from core.optimisers import hcpa

SEARCHED_LOAD = (0.0, 1.25)
MAX_GLOBAL, MAX_LOCAL = 500, 500
ADAPTIVENESS = 0.2
FINENESS = 30
SECTORS = 3
"""Of a cycle: a minimum in T_d is half a cycle wide, and no refinement crosses the maximum beside it."""
SEPARATE = 0.2
"""Greatest coordinate distance, over the box, below which two points are one."""

Callback = Callable[[Array, Array], bool | None]


@dataclass(frozen=True, slots=True)
class Found:
    """What the global search found.

    Parameters
    ----------
    vectors : ndarray, shape (points, entries)
        Vectors of the best separated points, best first.
    result : OptimizeResult
        All that was evaluated.
    """

    vectors: Array
    result: OptimizeResult


def box(records: Records) -> tuple[tuple[float, float], ...]:
    """Return the box that is searched.

    Its coordinates are the logarithms of the parameters over the expected ones, LL, and T_d in cycles.

    Parameters
    ----------
    records : Records
        Starts of one motor and how a point in the coordinates explains them.

    Returns
    -------
    tuple of tuple of float
        Lower and upper bound of each coordinate.
    """
    (start,) = records.starts
    spread = records.coordinates.prior.spread
    earliest, latest = (offset / start.cycle_s for offset in start.offset_range_s)
    reach = [log(spread[name]) for name in PARAMETERS]
    return (*((-one, one) for one in reach), SEARCHED_LOAD, (earliest, latest))


def with_switching_flux(points: Array, start: Start) -> Array:
    """Add the switching flux to search points.

    Parameters
    ----------
    points : ndarray, shape (m, 7)
        Search points.
    start : Start
        The start.

    Returns
    -------
    ndarray, shape (m, 9)
        Vectors.
    """
    flux = start.switching_flux(points[:, 6] * start.cycle_s) / start.rated_flux_Vs
    return np.concatenate([points, flux], axis=1)


def search(records: Records, *, most_points: int, callback: Callback | None = None) -> Found:
    """Search one (thinned) start; return its best points that lie apart from each other.

    Parameters
    ----------
    records : Records
        Starts of one motor and how a point in the coordinates explains them.
    most_points : int
        Most points that are returned.
    callback : callable or None, optional
        Called with new points (m, d) and their values (m,); a true answer stops the search.

    Returns
    -------
    Found
        The points.
    """
    (start,) = records.starts
    bounds = box(records)
    energy = float((start.measured_ab**2).sum())

    def cost(points: Array) -> Array:
        return records.squared_errors(with_switching_flux(points, start)) / energy

    result = hcpa.minimise(
        cost,
        bounds,
        adaptiveness=ADAPTIVENESS,
        fineness=FINENESS,
        exclusion=0.0,
        max_global=MAX_GLOBAL,
        max_local=MAX_LOCAL,
        batch=True,
        callback=callback,
    )
    sectors = SECTORS if start.offset_hint_s is None else 1
    points = _separated(result, np.array(bounds), sectors, most_points)
    return Found(with_switching_flux(points, start), result)


def _separated(result: OptimizeResult, bounds: Array, sectors: int, most: int) -> Array:
    """Choose the best points that lie apart, as many from each sector of T_d."""
    lower, width = bounds[:, 0], bounds[:, 1] - bounds[:, 0]
    unit = (result.points - lower) / width
    sector = np.minimum((unit[:, 6] * sectors).astype(np.int64), sectors - 1)
    chosen: list[int] = []
    taken = np.zeros(sectors, dtype=np.int64)
    for index in np.argsort(result.costs).tolist():
        apart = all(np.abs(unit[index] - unit[other]).max() >= SEPARATE for other in chosen)
        if apart and taken[sector[index]] < most // sectors:
            chosen.append(index)
            taken[sector[index]] += 1
        if len(chosen) == most:
            break
    return np.asarray(result.points[chosen])
