"""Layout of what a follower keeps of a motor: flat records of float64, which numba reads and a file holds."""

from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from core.machines.base import Array

START: Final = 8
"""Records that are put in order before the first of them counts; changes are looked for after them."""
CANDIDATES: Final = 18
"""Onsets of a change that are kept; about three per octave of age."""
SIDES: Final = 4
"""Side channels: V0/V1, I0/I1, v2, and how v2 differs from the bus."""
V0, I0, V2, BUS = range(SIDES)
CIRCLE_STATES: Final = 9
CIRCLE_COLUMNS: Final = 5
"""Changes of the current beside its circle: two of shorted turns, two of a channel, one of a joint."""
TURNS, CHANNEL, JOINT = range(3)
RECENT: Final = 64
"""Latest records, or means of several, that are kept for the level since a change."""

ComplexArray = NDArray[np.complex128]


class FilterState(Protocol):
    """Kalman filter of the standing errors; see `core.condition.filter.kalman`.

    Attributes
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
        Noise variance of each part of y in the latest record, as the filter took it.
    s2 : float
        Learnt variance of y's noise (complex, both parts together).
    current_deviation : float
        sd_C, standard deviation of each part of C before the first record.
    records : float
        Number of records.
    gap_s : float
        Mean time between records [s].
    surprise : float
        Squared innovation of the latest record over its variance, a chi-square of 2.
    share : float
        Share of the noise in the innovation's variance.
    noise_score, noise_information : float
        Slope and curvature of the latest record's log-likelihood over ln s2.
    noise_known : float
        Number of records that s2 is known from, each counted by what it tells.
    log_likelihood : float
        Log density of the latest record, but for a constant.
    candidates, recent : float
        Number of candidates, and of the entries of the recent records.
    block : float
        Number of records that an entry of the recent records is the mean of.
    nominal : complex
        Z2n / z at rated frequency.
    balance : float
        Share of y's noise that the currents make; see `regressor`.
    w, w_raw : complex
        Regressor of the latest record, without its noise and with it.
    w_near, w_far : float
        Mean squares by which it differs from the record before, and from that 16 records before.
    statistic, threshold : float
        Logs of the detector's statistic and of its threshold.
    drift_E, drift_C : float
        Variances by which each part of E and C wanders besides from record to record, because a drift that
        has been taken into them may go on.
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
    gap_s: float
    surprise: float
    share: float
    noise_score: float
    noise_information: float
    noise_known: float
    log_likelihood: float
    candidates: float
    recent: float
    block: float
    nominal: complex
    balance: float
    w: complex
    w_raw: complex
    w_near: float
    w_far: float
    statistic: float
    threshold: float
    drift_E: float
    drift_C: float


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
        ("gap_s", "f8"),
        ("surprise", "f8"),
        ("share", "f8"),
        ("noise_score", "f8"),
        ("noise_information", "f8"),
        ("noise_known", "f8"),
        ("log_likelihood", "f8"),
        ("candidates", "f8"),
        ("recent", "f8"),
        ("block", "f8"),
        ("nominal", "c16"),
        ("balance", "f8"),
        ("w", "c16"),
        ("w_raw", "c16"),
        ("w_near", "f8"),
        ("w_far", "f8"),
        ("statistic", "f8"),
        ("threshold", "f8"),
        ("drift_E", "f8"),
        ("drift_C", "f8"),
    ]
)


class SideState(Protocol):
    """Kalman filter of one side channel, z = level + slope w; see `core.condition.filter.side_channels`.

    Attributes
    ----------
    x : ndarray of complex, shape (2,)
        Level and slope.
    P : ndarray of complex, shape (2, 2)
        Covariance.
    K : ndarray of complex, shape (2,)
        Gain of the latest record.
    nu : complex
        Innovation.
    S : float
        Variance of the innovation (complex); 0 where the record has no such channel.
    regressor : complex
        w of the latest record.
    q, r : float
        Learnt variances of the level's wander and of the noise.
    before, difference : complex
        z - slope w of the record before, and its difference from the one before that.
    square, product : float
        Means of the differences' squares and of the products of neighbouring ones, which tell q and r.
    records : float
        Number of records.
    """

    x: ComplexArray
    P: ComplexArray
    K: ComplexArray
    nu: complex
    S: float
    regressor: complex
    q: float
    r: float
    before: complex
    difference: complex
    square: float
    product: float
    records: float


SIDE: Final = np.dtype(
    [
        ("x", "c16", (2,)),
        ("P", "c16", (2, 2)),
        ("K", "c16", (2,)),
        ("nu", "c16"),
        ("S", "f8"),
        ("regressor", "c16"),
        ("q", "f8"),
        ("r", "f8"),
        ("before", "c16"),
        ("difference", "c16"),
        ("square", "f8"),
        ("product", "f8"),
        ("records", "f8"),
    ]
)


class CircleState(Protocol):
    """Kalman filter of the current beside its circle; see `core.condition.filter.circle`.

    Attributes
    ----------
    x, spread : ndarray, shape (9,)
        Unknowns, and their standard deviations before the first record.
    P : ndarray, shape (9, 9)
        Covariance.
    h, K : ndarray, shape (9,)
        Slopes and gain of the latest record.
    columns : ndarray, shape (5,)
        What each change would add to it.
    nu, S : float
        Innovation and its variance; a variance of 0 where the record has no such figure.
    rho : float
        By how much temperature has faded since the record before.
    s2, known : float
        Learnt variance of the noise, and the number of records that it is known from.
    """

    x: Array
    spread: Array
    P: Array
    h: Array
    K: Array
    columns: Array
    nu: float
    S: float
    rho: float
    s2: float
    known: float


CIRCLE: Final = np.dtype(
    [
        ("x", "f8", (CIRCLE_STATES,)),
        ("spread", "f8", (CIRCLE_STATES,)),
        ("P", "f8", (CIRCLE_STATES, CIRCLE_STATES)),
        ("h", "f8", (CIRCLE_STATES,)),
        ("K", "f8", (CIRCLE_STATES,)),
        ("columns", "f8", (CIRCLE_COLUMNS,)),
        ("nu", "f8"),
        ("S", "f8"),
        ("rho", "f8"),
        ("s2", "f8"),
        ("known", "f8"),
    ]
)


class Candidate(Protocol):
    """A change that may have begun with one record; see `core.condition.filter.change_bank`.

    Attributes
    ----------
    time_ns : int
        Time of that record, UTC [ns].
    onset : float
        Number of that record.
    weight : float
        Number of onsets that it stands for.
    f : ndarray, shape (7, 10)
        What the filter's state has taken up of each jump.
    step, impedance, ramp_voltage, ramp_current : ndarray, shapes (4, 4), (2, 2), (2, 2), (2, 2)
        Information on the jumps of E and C, of r + j x, on the ramp of E, and on that of C.
    d : ndarray, shape (10,)
        Information vector.
    side_f : ndarray of complex, shape (4, 2, 2)
        What each side channel's level and slope have taken up of a step and of a ramp.
    side_information : ndarray, shape (4, 2)
        Information on the step and the ramp of each side channel.
    side_d : ndarray of complex, shape (4, 2)
        Information vector.
    circle_f : ndarray, shape (9, 10)
        What the filter of the circle has taken up of each step and ramp.
    circle_information : ndarray, shape (2, 3, 3)
        Information on the step and the ramp of shorted turns, of a channel and of a joint, elements 00, 01,
        11.
    circle_d : ndarray, shape (2, 5)
        Information vector.
    """

    time_ns: int
    onset: float
    weight: float
    f: Array
    step: Array
    impedance: Array
    ramp_voltage: Array
    ramp_current: Array
    d: Array
    side_f: NDArray[np.complex128]
    side_information: Array
    side_d: ComplexArray
    circle_f: Array
    circle_information: Array
    circle_d: Array


CANDIDATE: Final = np.dtype(
    [
        ("time_ns", "i8"),
        ("onset", "f8"),
        ("weight", "f8"),
        ("f", "f8", (7, 10)),
        ("step", "f8", (4, 4)),
        ("impedance", "f8", (2, 2)),
        ("ramp_voltage", "f8", (2, 2)),
        ("ramp_current", "f8", (2, 2)),
        ("d", "f8", (10,)),
        ("side_f", "c16", (SIDES, 2, 2)),
        ("side_information", "f8", (SIDES, 2)),
        ("side_d", "c16", (SIDES, 2)),
        ("circle_f", "f4", (CIRCLE_STATES, 2 * CIRCLE_COLUMNS)),
        ("circle_information", "f4", (2, 3, 3)),
        ("circle_d", "f4", (2, CIRCLE_COLUMNS)),
    ]
)


class Recent(Protocol):
    """Mean of one or several records in a row.

    Attributes
    ----------
    time_ns : int
        Time of the latest of them, UTC [ns].
    count : float
        Number of records.
    y, j1, j2 : complex
        Means.
    R : float
        Mean noise variance of each part of y.
    """

    time_ns: int
    count: float
    y: complex
    j1: complex
    j2: complex
    R: float


RECENT_RECORD: Final = np.dtype(
    [("time_ns", "i8"), ("count", "f8"), ("y", "c16"), ("j1", "c16"), ("j2", "c16"), ("R", "f8")]
)
