"""Layout of what a follower keeps of a motor: flat records of float64, which numba reads and a file holds."""

from typing import Final, Protocol

import numpy as np

from core.machines.base import Array

START: Final = 8
"""Records that are put in order before the first of them counts; changes are looked for after them."""


class FilterState(Protocol):
    """Kalman filter of the standing errors; see `core.condition.kalman`.

    Parameters
    ----------
    x : ndarray, shape (7,)
        E_re, E_im, C_re, C_im, r, x, t.
    P : ndarray, shape (7, 7)
        Its covariance.
    x0, P0 : ndarray, shapes (7,), (7, 7)
        State and covariance before the first record.
    H, K, S_inverse, nu : ndarray, shapes (2, 7), (7, 2), (2, 2), (2,)
        Measurement matrix, gain, inverse covariance and innovation of the latest record.
    R : float
        Noise variance of each part of y in the latest record.
    s2 : float
        Learnt variance of y's noise (complex, both parts together).
    current_deviation : float
        sd_C, standard deviation of each part of C before the first record.
    records : float
        Number of records.
    surprise : float
        Squared innovation of the latest record over its variance, a chi-square of 2.
    share : float
        Share of the noise in the innovation's variance.
    log_likelihood : float
        Log density of the latest record, but for a constant.
    """

    x: Array
    P: Array
    x0: Array
    P0: Array
    H: Array
    K: Array
    S_inverse: Array
    nu: Array
    R: float
    s2: float
    current_deviation: float
    records: float
    surprise: float
    share: float
    log_likelihood: float


FILTER: Final = np.dtype(
    [
        ("x", "f8", (7,)),
        ("P", "f8", (7, 7)),
        ("x0", "f8", (7,)),
        ("P0", "f8", (7, 7)),
        ("H", "f8", (2, 7)),
        ("K", "f8", (7, 2)),
        ("S_inverse", "f8", (2, 2)),
        ("nu", "f8", (2,)),
        ("R", "f8"),
        ("s2", "f8"),
        ("current_deviation", "f8"),
        ("records", "f8"),
        ("surprise", "f8"),
        ("share", "f8"),
        ("log_likelihood", "f8"),
    ]
)
