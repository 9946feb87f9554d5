"""Regions around local minima that the Hyperbolic Cross Point Algorithm searches no more."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Point = tuple[int, ...]


class Exclusion:
    """Boxes of one size around points with whole coordinates; the faces do not belong to them.

    A step asks about points that differ from its centre in one coordinate each, so only the boxes that hold
    all other coordinates of the centre have to be looked at closely: one comparison with all boxes a step.

    Parameters
    ----------
    dimensions : int
        Number of coordinates.
    reach : float
        Half the side of a box.
    """

    def __init__(self, dimensions: int, reach: float) -> None:
        self._reach = reach
        self._centres = np.empty((16, dimensions))
        self._count = 0

    def add(self, point: Point) -> None:
        """Exclude the box around a point, unless the point is excluded already.

        Parameters
        ----------
        point : Point
            Its coordinates.
        """
        place = np.array(point, dtype=np.float64)
        if self._inside(place).all(axis=1).any():
            return
        if self._count == len(self._centres):
            self._centres = np.concatenate([self._centres, np.empty_like(self._centres)])
        self._centres[self._count] = place
        self._count += 1

    def outside(self, centre: Point, around: Sequence[Point]) -> list[Point]:
        """Return those of the points around a centre that lie in no box.

        Parameters
        ----------
        centre : Point
            The point in the middle.
        around : sequence of Point
            Points that differ from the centre in at most one coordinate each.

        Returns
        -------
        list of Point
            The points outside.
        """
        inside = self._inside(np.array(centre, dtype=np.float64))
        near = self._centres[: self._count][inside.sum(axis=1) >= len(centre) - 1]
        if not near.size:
            return list(around)
        gaps = np.abs(np.array(around, dtype=np.float64).reshape(-1, 1, len(centre)) - near)
        excluded = (gaps < self._reach).all(axis=2).any(axis=1)
        return [point for point, out in zip(around, excluded.tolist(), strict=True) if not out]

    def _inside(self, place: NDArray[np.float64]) -> NDArray[np.bool_]:
        return np.asarray(np.abs(self._centres[: self._count] - place) < self._reach)
