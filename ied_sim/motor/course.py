"""Quantities that develop over hours and days, as functions of time alone."""

from itertools import pairwise

Points = tuple[tuple[float, float], ...]
"""Points (time [s], value) in order of time, joined by lines."""


def value_at(points: Points, time_s: float) -> float:
    """Return the value at one moment; it is constant before the first and after the last point."""
    for (begin_s, begin), (end_s, end) in pairwise(points):
        if begin_s <= time_s < end_s:
            return begin + (end - begin) * (time_s - begin_s) / (end_s - begin_s)
    return points[0][1] if time_s < points[0][0] else points[-1][1]
