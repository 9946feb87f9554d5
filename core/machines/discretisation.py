"""Exact step of a linear system whose input is a straight line between samples (first-order hold).

    x' = A x + B u + D e,   u(t) = u_k + (u_k+1 - u_k) (t - t_k) / h,   e constant over the step
    x_k+1 = E x_k + G0 u_k + G1 u_k+1 + H e,        E = exp(A h)

u is the stator's voltage (rows 0, 1), e a voltage of the rotor circuits (rows 2, 3).

The integrals of the exponential are summed as series over a step short enough to converge, then doubled:
A-stable for any A, so a loop that decays in a microsecond is stepped at 0.1 ms without harm.
Van Loan, IEEE Trans. Autom. Control 23(3), 1978; Higham, Functions of Matrices, 2008, chapter 10.
"""

from typing import NamedTuple

import numpy as np

from core.machines.base import Array
from core.machines.compiled import compiled

STATES = 5
INPUTS = 4
SERIES_TERMS = 10
SERIES_NORM = 0.25


class Hold(NamedTuple):
    """Matrices of one step, x_k+1 = E x_k + G0 u_k + G1 u_k+1 + H e; in the kernel with an axis of lanes.

    Parameters
    ----------
    E : ndarray, shape (5, 5)
        Propagation of the state.
    G0, G1 : ndarray, shape (5, 2)
        Effect of the voltage at the step's beginning and end.
    H : ndarray, shape (5, 2)
        Effect of the rotor's voltage.
    """

    E: Array
    G0: Array
    G1: Array
    H: Array


@compiled
def multiply(a: Array, b: Array, out: Array) -> None:
    """Multiply small matrices, out = a b, without the call into a linear algebra library.

    Parameters
    ----------
    a : ndarray, shape (m, k)
        First factor.
    b : ndarray, shape (k, n)
        Second factor.
    out : ndarray, shape (m, n)
        Filled with the product.
    """
    for i in range(a.shape[0]):
        for j in range(b.shape[1]):
            total = 0.0
            for k in range(a.shape[1]):
                total += a[i, k] * b[k, j]
            out[i, j] = total


@compiled
def invert(matrix: Array, inverse: Array) -> None:
    """Invert a 5 x 5 matrix whose diagonal dominates, by Gauss and Jordan without pivoting.

    Parameters
    ----------
    matrix : ndarray, shape (5, 5)
        The matrix.
    inverse : ndarray, shape (5, 5)
        Filled with its inverse.
    """
    work = np.empty((5, 5))
    for i in range(5):
        for j in range(5):
            work[i, j] = matrix[i, j]
            inverse[i, j] = 1.0 if i == j else 0.0
    for i in range(5):
        pivot = 1.0 / work[i, i]
        for j in range(5):
            work[i, j] *= pivot
            inverse[i, j] *= pivot
        for row in range(5):
            if row != i:
                factor = work[row, i]
                for j in range(5):
                    work[row, j] -= factor * work[i, j]
                    inverse[row, j] -= factor * inverse[i, j]


@compiled
def row_norm(A: Array) -> float:
    """Return the greatest sum of the sizes in a row.

    Parameters
    ----------
    A : ndarray, shape (m, n)
        The matrix.

    Returns
    -------
    float
        Its row norm.
    """
    norm = 0.0
    for i in range(A.shape[0]):
        total = 0.0
        for j in range(A.shape[1]):
            total += abs(A[i, j])
        norm = max(norm, total)
    return norm


@compiled
def sum_series(X: Array, step: float, E: Array, level: Array, ramp: Array) -> None:
    """Sum the series of the exponential and of its integrals over a short step h.

    E = sum X^k / k!, level = h sum X^k / (k+1)! B and ramp = h sum X^k / (k+2)! B.

    Parameters
    ----------
    X : ndarray, shape (5, 5)
        A h.
    step : float
        h [s].
    E : ndarray, shape (5, 5)
        Filled.
    level, ramp : ndarray, shape (5, 4)
        Filled.
    """
    term, product = np.eye(STATES), np.empty((STATES, STATES))
    E[:], level[:], ramp[:] = 0.0, 0.0, 0.0
    for k in range(SERIES_TERMS):
        multiply(term, X, product)
        for i in range(STATES):
            for j in range(INPUTS):
                level[i, j] += term[i, j] * (step / (k + 1))
                ramp[i, j] += term[i, j] * (step / ((k + 1) * (k + 2)))
            for j in range(STATES):
                E[i, j] += term[i, j]
                term[i, j] = product[i, j] / (k + 1)


@compiled
def double_step(E: Array, level: Array, ramp: Array) -> None:
    """Turn the matrices into those of twice the step.

    The second half begins where the first ended, with its ramp at a half.

    Parameters
    ----------
    E : ndarray, shape (5, 5)
        Propagation of the state.
    level, ramp : ndarray, shape (5, 4)
        Effect of a constant input and of its ramp.
    """
    E_ramp, E_level, E_E = np.empty((STATES, INPUTS)), np.empty((STATES, INPUTS)), np.empty((STATES, STATES))
    multiply(E, ramp, E_ramp)
    multiply(E, level, E_level)
    multiply(E, E, E_E)
    for i in range(STATES):
        for j in range(INPUTS):
            ramp[i, j] = 0.5 * (E_ramp[i, j] + ramp[i, j] + level[i, j])
            level[i, j] += E_level[i, j]
        for j in range(STATES):
            E[i, j] = E_E[i, j]


@compiled
def first_order_hold(A: Array, step: float, hold: Hold) -> None:
    """Fill the hold of x' = A x + [u; e; 0] over a step; it is not finite where A is not.

    Parameters
    ----------
    A : ndarray, shape (5, 5)
        Matrix of the system [1/s].
    step : float
        Step [s].
    hold : Hold
        Matrices of a step, which are filled.
    """
    norm, doublings = row_norm(A) * step, 0
    while norm > SERIES_NORM and np.isfinite(norm):
        norm *= 0.5
        doublings += 1
    short = step * 0.5**doublings
    level, ramp = np.empty((STATES, INPUTS)), np.empty((STATES, INPUTS))
    sum_series(A * short, short, hold.E, level, ramp)
    for _ in range(doublings):
        double_step(hold.E, level, ramp)
    for i in range(STATES):
        for j in range(2):
            hold.G0[i, j] = level[i, j] - ramp[i, j]
            hold.G1[i, j] = ramp[i, j]
            hold.H[i, j] = level[i, j + 2]


@compiled
def discretise(decay: Array, w: float, step: float, hold: Hold) -> None:
    """Fill the hold of a machine, A = decay + w Jr, at an electrical speed.

    Parameters
    ----------
    decay : ndarray, shape (5, 5)
        Matrix of the flux's decay, -R inv(L) [1/s].
    w : float
        Electrical speed [rad/s].
    step : float
        Step [s].
    hold : Hold
        Matrices of a step, which are filled.
    """
    A = decay.copy()
    A[2, 3] -= w
    A[3, 2] += w
    first_order_hold(A, step, hold)
