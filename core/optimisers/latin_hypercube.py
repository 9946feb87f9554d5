"""Latin hypercube sampling: points of which every coordinate is spread evenly (thesis section 6.5.1).

McKay, Beckman and Conover, Technometrics 21 (1979), doi:10.1080/00401706.1979.10489755; the sampler is
scipy's.
"""

from scipy.stats.qmc import LatinHypercube

from core.optimisers.objective import Array


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
