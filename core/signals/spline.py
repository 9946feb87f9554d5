"""Cubic splines on equal steps."""

from math import sqrt

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

POLE = sqrt(3.0) - 2.0
"""Root of z^2 + 4 z + 1 inside the unit circle: how fast one sample's influence dies away."""

REACH = 40
"""Samples after which it has: |POLE|^40 is 1e-23."""


def refine(x: Array, substeps: int) -> Array:
    """Interpolate signals at equal fractions of their steps by a cubic spline.

    The spline is the one of `scipy.interpolate.CubicSpline` (not-a-knot ends). On equal steps its second
    derivatives are a convolution of the second differences, so that no system of equations is left; and the
    import of scipy.interpolate takes longer than a whole diagnosis.

    Parameters
    ----------
    x : (m, n) array
        Signals, one a row, at least two samples each.
    substeps : int
        Number of new steps in each old one.

    Returns
    -------
    (m, (n - 1) substeps + 1) array
        The signals at the finer steps; every `substeps`-th sample is the given one.

    References
    ----------
    Unser, "Splines: a perfect fit for signal and image processing", IEEE Signal Processing Magazine 16
    (1999), doi:10.1109/79.799930.
    """
    curvature = _second_derivatives(x)
    s = np.arange(substeps) / substeps
    rest = 1.0 - s
    fine = (
        x[:, :-1, None] * rest
        + x[:, 1:, None] * s
        + curvature[:, :-1, None] * ((rest**3 - rest) / 6.0)
        + curvature[:, 1:, None] * ((s**3 - s) / 6.0)
    )
    return np.concatenate([fine.reshape(x.shape[0], -1), x[:, -1:]], axis=1)


def _second_derivatives(x: Array) -> Array:
    """Second derivatives (m, n) at the samples, a step being 1."""
    n = x.shape[1]
    if n == 2:
        return np.zeros_like(x)
    difference = x[:, 2:] - 2.0 * x[:, 1:-1] + x[:, :-2]
    if n == 3:
        return np.repeat(difference, 3, axis=1)
    # M[i-1] + 4 M[i] + M[i+1] = 6 difference[i] inside. Not-a-knot ends say M[1] = difference[1], and so at
    # the other end: what the convolution misses there dies away like the pole.
    reach = min(n, REACH)
    kernel = 6.0 / (2.0 * sqrt(3.0)) * POLE ** np.abs(np.arange(-reach, reach + 1))
    inner = np.stack([np.convolve(row, kernel)[reach : reach + n - 2] for row in difference])
    decay = POLE ** np.arange(n - 2)
    ends = np.array([[1.0, decay[-1]], [decay[-1], 1.0]])
    missing = (difference - inner)[:, [0, -1]].T
    left, right = np.linalg.solve(ends, missing)[:, :, None]
    inner += left * decay + right * decay[::-1]
    first, last = 2.0 * inner[:, [0]] - inner[:, [1]], 2.0 * inner[:, [-1]] - inner[:, [-2]]
    return np.concatenate([first, inner, last], axis=1)
