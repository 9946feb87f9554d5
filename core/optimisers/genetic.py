"""A genetic algorithm with the settings of the thesis (section 6.3.2, Table 6.1).

The thesis used MATLAB's: parents drawn by stochastic universal sampling on ranks, 1 / sqrt(rank); children
by scattered crossover (each coordinate from either parent) or by Gaussian mutation whose width shrinks with
the generations. scipy's differential evolution is another algorithm, and the packaged genetic algorithms
(pymoo, PyGAD) know neither an elite beside a crossover fraction nor this mutation, and bring no types; so
its three operators stand here.
"""

import numpy as np
from scipy.optimize import OptimizeResult

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
    population: int = 20,
    elite: int = 5,
    crossover: float = 0.4,
    generations: int = 25,
    seed: int = 0,
    batch: bool = False,
    callback: Callback | None = None,
) -> OptimizeResult:
    """Minimise a function over a box with the thesis's genetic algorithm (section 6.3.2).

    Parameters
    ----------
    fun : callable
        The objective, a function of one point (d,), or with `batch` of points (m, d).
    bounds : sequence of (float, float)
        Lower and upper bound of each coordinate.
    population : int, default 20
        Members of a generation.
    elite : int, default 5
        Best members, which live on unchanged and are not evaluated again.
    crossover : float, default 0.4
        Fraction of the others that have two parents; the rest are mutations.
    generations : int, default 25
        Number of generations after the first.
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
    checked_count("population", population, 2)
    checked_count("generations", generations, 0)
    if not (0 <= elite < population and 0.0 <= crossover <= 1.0):
        raise OptimiserError(
            f"expected 0 <= elite < population = {population} and crossover from 0 to 1: "
            f"found {elite}, {crossover}"
        )
    random = np.random.default_rng(seed)
    evaluations = Evaluations(as_batch(fun, batch=batch), box, callback=callback)
    crossed = round(crossover * (population - elite))
    message = f"bred {generations} generations"
    generation = 0
    try:
        members = random.random((population, box.dimensions))
        values = evaluations(members)
        for generation in range(1, generations + 1):
            order = np.argsort(values, kind="stable")
            members = members[order]
            parents = members[_drawn(random, population, 2 * crossed + population - elite - crossed)]
            width = 1.0 - (generation - 1) / generations
            members = np.concatenate(
                [
                    members[:elite],
                    _scattered(random, parents[:crossed], parents[crossed : 2 * crossed]),
                    _mutated(random, parents[2 * crossed :], width),
                ]
            )
            values = evaluations(members)
    except Stopped as stop:
        message = str(stop)
    return evaluations.result(message, generation)


def _drawn(
    random: np.random.Generator, population: int, count: int
) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Draw indices of parents among members in order of rank: equal steps along their shares (Baker 1987)."""
    shares = 1.0 / np.sqrt(np.arange(1, population + 1))
    edges = np.cumsum(shares) / shares.sum()
    marks = (random.random() + np.arange(count)) / count
    drawn = np.minimum(np.searchsorted(edges, marks), population - 1)
    return random.permutation(drawn)


def _scattered(random: np.random.Generator, mothers: Array, fathers: Array) -> Array:
    return np.where(random.random(mothers.shape) < 0.5, mothers, fathers)


def _mutated(random: np.random.Generator, parents: Array, width: float) -> Array:
    """Gaussian steps of `width` (fractions of the box), reflected at its faces."""
    moved = np.abs(parents + width * random.standard_normal(parents.shape)) % 2.0
    return np.where(moved > 1.0, 2.0 - moved, moved)
