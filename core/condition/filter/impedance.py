"""The error of a motor's impedance, carried over where the motor's file or its reference becomes another."""

import numpy as np

from core.condition.complex_parts import turned
from core.condition.filter.kalman import TEMPERATURE
from core.condition.filter.prior import IMPEDANCE
from core.condition.filter.state import FilterState
from core.machines.base import Array


def move_impedance(state: FilterState, before: complex, after: complex) -> None:
    """Keep Z2 and the standing errors as they are known, where the file promises another Z2.

    Parameters
    ----------
    state : FilterState
        The filter; its x, x0 and nominal change.
    before, after : complex
        Z2n / z of the motor's file before and after.
    """
    b = state.balance
    for x in (state.x, state.x0):
        found = complex(x[4], x[5]) / before
        Z2 = before * (1.0 + (1.0 - b) * found) / (1.0 - b * found)
        other = (Z2 / after - 1.0) / (1.0 + b * (Z2 / after - 1.0))
        ratio = (1.0 - b * other) / (1.0 - b * found)
        x[0], x[1] = turned(x[:2], ratio)
        x[2], x[3] = turned(x[2:4], ratio)
        x[4], x[5] = (after * other).real, (after * other).imag
    state.nominal = after


def impedance_alone(state: FilterState) -> tuple[Array, Array]:
    """Return what is known of the impedance's error and the temperature where E may be anything.

    On a supply whose V2/V1 is constant nothing tells an error of the impedance from E but how large either
    may be. There shorted turns that stand from the first record on are taken for both. A reference that
    begins with E as unknown as at first must not be told that the impedance explains them.

    Parameters
    ----------
    state : FilterState
        The filter.

    Returns
    -------
    x : ndarray, shape (3,)
        Parts r and x of the error, and t.
    P : ndarray, shape (3, 3)
        Their covariance; that of before the first record where the records tell nothing without E's prior.
    """
    kept = slice(4, 7)
    if state.records == 0.0:  # there is no record yet by which E and the impedance could hang together
        return state.x[kept].copy(), state.P[kept, kept].copy()
    widest = max(
        IMPEDANCE**2, float(state.P0[4, 4])
    )  # more than usual where the file's parameters are doubtful
    usual = np.diag([widest, widest, TEMPERATURE**2])
    information = np.linalg.inv(state.P)
    without = information.copy()
    without[:2, :2] -= np.linalg.inv(state.P0[:2, :2])
    if np.linalg.eigvalsh(without)[0] <= 0.0:  # the filter has forgotten more than its prior told
        return np.zeros(3), usual
    spread = np.linalg.inv(without)
    if np.any(np.diag(spread)[4:6] >= widest):
        return np.zeros(3), usual
    return (spread @ (information @ state.x))[kept], spread[kept, kept]
