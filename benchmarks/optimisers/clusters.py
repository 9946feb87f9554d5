"""Several global minima: evaluated points in fuzzy clusters, a local search from each centre (section 4.4.4).

Fuzzy c-means: Bezdek, Pattern Recognition with Fuzzy Objective Function Algorithms, 1981. It is a dozen
lines; scikit-fuzzy, which has it, has neither types nor a release for numpy 2.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import OptimizeResult
from scipy.spatial.distance import cdist

from benchmarks.optimisers import nelder_mead
from core.optimisers import hcpa
from core.optimisers.evaluations import Evaluations, Halted
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

FUZZINESS = 2.0
MOST_SWEEPS = 300
SETTLED = 1e-6
"""Change of a membership below which clusters count as found."""


@dataclass(frozen=True, slots=True)
class Clusters:
    """Centres (clusters, d), and how much every point belongs to each (points, clusters): rows sum to 1."""

    centres: Array
    membership: Array


def fuzzy_c_means(points: Array, clusters: int, *, seed: int = 0) -> Clusters:
    """Clusters of points (m, d), from a random first membership."""
    membership = np.random.default_rng(seed).dirichlet(np.ones(clusters), len(points))
    centres = np.empty((clusters, points.shape[1]))
    for _ in range(MOST_SWEEPS):
        weights = membership**FUZZINESS
        centres = weights.T @ points / weights.sum(axis=0)[:, np.newaxis]
        # A point on a centre belongs to it alone; the smallest double keeps the quotient finite.
        closeness = np.maximum(cdist(points, centres), np.finfo(np.float64).tiny ** 0.25) ** (
            -2.0 / (FUZZINESS - 1.0)
        )
        new = closeness / closeness.sum(axis=1, keepdims=True)
        change = float(np.abs(new - membership).max())
        membership = new
        if change < SETTLED:
            break
    return Clusters(centres, membership)


def minimise(
    fun: PointFunction | BatchFunction,
    bounds: Bounds,
    *,
    clusters: int,
    adaptiveness: float = 0.8,
    max_global: int = 1_000,
    share: float = 1.0,
    seed: int = 0,
    batch: bool = False,
    callback: Callback | None = None,
) -> OptimizeResult:
    """Find `clusters` minima of `fun` in a box.

    HCPA with an adaptiveness that spreads its points, fuzzy c-means over the best `share` of them (1: all, as
    in the thesis), Nelder-Mead from each centre. Two searches may end in one minimum.

    Returns x, fun, nfev, nit, success, message, points (nfev, d), costs (nfev,), and centres, minimisers
    (clusters, d) and minima (clusters,), best first; fewer where the callback stopped the search.
    Raises OptimiserError for impossible arguments.
    """
    box = checked_bounds(bounds)
    checked_count("clusters", clusters, 1)
    checked_count("max_global", max_global, clusters)
    if not 0.0 < share <= 1.0:
        raise OptimiserError(f"share: expected above 0 and up to 1, found {share}")
    whole = Evaluations(as_batch(fun, batch=batch), box, callback=callback, staged=True)
    unit_box = [(0.0, 1.0)] * box.dimensions
    centres = np.empty((0, box.dimensions))
    found: list[OptimizeResult] = []
    try:
        hcpa.minimise(
            whole, unit_box, adaptiveness=adaptiveness, max_global=max_global, max_local=0, batch=True
        )
        kept = np.argsort(whole.values, kind="stable")[: max(clusters, round(share * whole.count))]
        centres = fuzzy_c_means(box.to_unit(whole.points[kept]), clusters, seed=seed).centres
        for centre in centres:
            found.append(nelder_mead.minimise(whole, unit_box, start=centre, batch=True))
        message = f"searched from the centres of {clusters} clusters"
    except Halted as stop:
        message = str(stop)
    result = whole.result(message, len(found))
    found.sort(key=lambda one: float(one.fun))
    result["centres"] = box.from_unit(centres)
    result["minimisers"] = box.from_unit(np.array([one.x for one in found]).reshape(-1, box.dimensions))
    result["minima"] = np.array([one.fun for one in found])
    return result
