"""Samples between samples, for channels that are late by less than one."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

MARGIN = 3
"""Samples that are needed before the first and after the last place."""


def interpolated(samples: Array, first: float, every: int, count: int) -> Array:
    """Return `count` values at the places first, first + every, ... between samples, shape (n,).

    A cubic through the four samples around each place (Lagrange). Of an oscillation with N samples a period
    it is off by less than (2 pi / N)^4 / 40.
    """
    begin = int(np.floor(first))
    x = first - begin
    places = begin + every * np.arange(count)
    weights = (
        -x * (x - 1) * (x - 2) / 6,
        (x + 1) * (x - 1) * (x - 2) / 2,
        -(x + 1) * x * (x - 2) / 2,
        (x + 1) * x * (x - 1) / 6,
    )
    values: Array = sum(
        (weight * samples[places + k - 1] for k, weight in enumerate(weights)), np.zeros(count)
    )
    return values
