"""Exact step of a linear system whose input is a straight line between samples (first-order hold).

    x' = A x + B u,   u(t) = u_k + (u_k+1 - u_k) (t - t_k) / h
    x_k+1 = E x_k + G0 u_k + G1 u_k+1,        E = exp(A h)

The integrals of the exponential are summed as series over a step short enough to converge, then doubled:
A-stable for any A, so a loop that decays in a microsecond is stepped at 0.1 ms without harm.
Van Loan, IEEE Trans. Autom. Control 23(3), 1978; Higham, Functions of Matrices, 2008, chapter 10.
"""

import numpy as np

from core.machines.base import Array
from core.machines.compiled import compiled

STATES = 5
INPUTS = 2
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
def first_order_hold(A: Array, step: float, E: Array, G0: Array, G1: Array) -> None:
    """Fill E (5, 5), G0 and G1 (5, 2) for x' = A x + [I; 0] u over `step` [s]."""
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
    G0[:] = hold - ramp
    G1[:] = ramp
