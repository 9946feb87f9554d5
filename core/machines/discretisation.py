"""Exact step of a linear system whose input is a straight line between samples (first-order hold).

    x' = A x + B u + D e,   u(t) = u_k + (u_k+1 - u_k) (t - t_k) / h,   e constant over the step
    x_k+1 = E x_k + G0 u_k + G1 u_k+1 + H e,        E = exp(A h)

u is the stator's voltage (rows 0, 1), e a voltage of the rotor circuits (rows 2, 3).

The integrals of the exponential are summed as series over a step short enough to converge, then doubled:
A-stable for any A, so a loop that decays in a microsecond is stepped at 0.1 ms without harm.
Van Loan, IEEE Trans. Autom. Control 23(3), 1978; Higham, Functions of Matrices, 2008, chapter 10.
"""

import numpy as np

from core.machines.base import Array
from core.machines.compiled import compiled

STATES = 5
INPUTS = 4
SERIES_TERMS = 10
SERIES_NORM = 0.25


@compiled
def multiply(a: Array, b: Array, out: Array) -> None:
    """out = a b for small matrices, without the call into a linear algebra library."""
    for i in range(a.shape[0]):
        for j in range(b.shape[1]):
            total = 0.0
            for k in range(a.shape[1]):
                total += a[i, k] * b[k, j]
            out[i, j] = total


@compiled
def invert(matrix: Array, inverse: Array) -> None:
    """Inverse of a 5 x 5 matrix whose diagonal dominates, by Gauss and Jordan without pivoting."""
    work = matrix.copy()
    inverse[:] = np.eye(5)
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
def first_order_hold(A: Array, step: float, E: Array, G0: Array, G1: Array, H: Array) -> None:
    """Fill E (5, 5), G0, G1 and H (5, 2) for x' = A x + [u; e; 0] over `step` [s]."""
    norm = np.abs(A).sum(axis=1).max() * step
    doublings = 0
    while norm > SERIES_NORM:
        norm *= 0.5
        doublings += 1
    short = step * 0.5**doublings

    # E = sum X^k / k!;  hold = h sum X^k / (k+1)! B;  ramp = h sum X^k / (k+2)! B, with X = A h
    X = A * short
    term, product = np.eye(STATES), np.empty((STATES, STATES))
    hold, ramp, carried = np.zeros((STATES, INPUTS)), np.zeros((STATES, INPUTS)), np.empty((STATES, INPUTS))
    E[:] = 0.0
    for k in range(SERIES_TERMS):
        E += term
        hold += term[:, :INPUTS] * (short / (k + 1))
        ramp += term[:, :INPUTS] * (short / ((k + 1) * (k + 2)))
        multiply(term, X, product)
        term[:] = product / (k + 1)

    # twice the step: the second half starts where the first ended, its ramp from one half
    for _ in range(doublings):
        multiply(E, ramp, carried)
        ramp[:] = 0.5 * (carried + ramp + hold)
        multiply(E, hold, carried)
        hold += carried
        multiply(E, E, product)
        E[:] = product
    G0[:] = hold[:, :2] - ramp[:, :2]
    G1[:] = ramp[:, :2]
    H[:] = hold[:, 2:]


@compiled
def discretise(decay: Array, w: float, step: float, E: Array, G0: Array, G1: Array, H: Array) -> None:
    """The hold of a machine, A = decay + w Jr, at the electrical speed w [rad/s]."""
    A = decay.copy()
    A[2, 3] -= w
    A[3, 2] += w
    first_order_hold(A, step, E, G0, G1, H)
