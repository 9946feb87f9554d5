"""The filter's state as it would be without what the likeliest change has put into it.

The filter knows nothing of a change. Until one is certain, it takes up f g of it: on a supply whose V2/V1
is constant, shorted turns look like an error of the impedance beside another standing asymmetry.
"""

import numpy as np

from core.condition.changes.evidence import most_of_pair
from core.condition.filter.change_bank import RAMP_LENGTH
from core.condition.filter.kalman import STATES, rows
from core.condition.filter.state import Candidate, FilterState
from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled

PAIRS = 5
"""Pairs of columns that may have changed: steps of E, C and r + jx, ramps of E and C."""


@compiled
def before_change(state: FilterState, bank: list[Candidate]) -> tuple[Array, Array]:
    """Return the state of the filter without the likeliest change, whatever its size and direction.

    Parameters
    ----------
    state : FilterState
        The filter.
    bank : array of Candidate
        Candidates.

    Returns
    -------
    x : ndarray, shape (7,)
        x - f Lambda^-1 d.
    P : ndarray, shape (7, 7)
        Its covariance, P + f Lambda^-1 f'.
    """
    x, P = state.x.copy(), state.P.copy()
    at, column = likeliest_jump(state, bank)
    if at < 0:
        return x, P
    one = bank[at]
    a, b, c = _information(one, column // 2)
    determinant = a * c - b * b
    spread = np.array([[c / determinant, -b / determinant], [-b / determinant, a / determinant]])
    taken = np.zeros((STATES, 2))
    for k in range(STATES):
        for j in range(2):
            taken[k, j] = one.f[k, column] * spread[0, j] + one.f[k, column + 1] * spread[1, j]
    for k in range(STATES):
        x[k] -= taken[k, 0] * one.d[column] + taken[k, 1] * one.d[column + 1]
        for j in range(STATES):
            P[k, j] += taken[k, 0] * one.f[j, column] + taken[k, 1] * one.f[j, column + 1]
    return x, P


@compiled
def likeliest_jump(state: FilterState, bank: list[Candidate]) -> tuple[int, int]:
    """Return the likeliest change, whatever its direction.

    Parameters
    ----------
    state : FilterState
        The filter.
    bank : array of Candidate
        Candidates.

    Returns
    -------
    at : int
        Its onset; below zero where there is none.
    column : int
        The first of its two columns of J.
    """
    at, column, most = -1, 0, 0.0
    for i in range(int(state.candidates)):
        for pair in range(PAIRS):
            evidence = _most(bank[i], pair)
            if evidence > most:
                at, column, most = i, 2 * pair, evidence
    return at, column


@compiled
def expected(
    state: FilterState, bank: list[Candidate], j1: complex, j2: complex
) -> tuple[tuple[float, float], int, bool]:
    """Return what the likeliest change adds to the innovation of the next record.

    Parameters
    ----------
    state : FilterState
        The filter, before the record; its H is filled.
    bank : array of Candidate
        Candidates.
    j1, j2 : complex
        The record.

    Returns
    -------
    added : tuple of float
        Real and imaginary part.
    at : int
        Onset of the change; below zero where there is none.
    drifts : bool
        Whether it drifts.
    """
    at, column = likeliest_jump(state, bank)
    if at < 0:
        return (0.0, 0.0), at, False
    H, one = state.H, bank[at]
    rows(j1, j2, H)
    a, b, c = _information(one, column // 2)
    determinant = a * c - b * b
    d0, d1 = one.d[column], one.d[column + 1]
    g = (c * d0 - b * d1) / determinant, (a * d1 - b * d0) / determinant
    ramp = (state.records - one.onset + 1.0) / RAMP_LENGTH
    added0 = added1 = 0.0
    for k in range(2):
        first = column + k if column < 6 else column + k - 6
        shape = 1.0 if column < 6 else ramp
        G0, G1 = shape * H[0, first], shape * H[1, first]
        for j in range(STATES):
            G0 -= H[0, j] * one.f[j, column + k]
            G1 -= H[1, j] * one.f[j, column + k]
        added0 += G0 * g[k]
        added1 += G1 * g[k]
    return (added0, added1), at, column >= 6


@compiled
def _most(one: Candidate, pair: int) -> float:
    """Return the evidence that no change of a pair of columns can exceed."""
    if pair < 2:
        return most_of_pair(one.step, 2 * pair, one.d, 2 * pair)
    if pair == 2:
        return most_of_pair(one.impedance, 0, one.d, 4)
    if pair == 3:
        return most_of_pair(one.ramp_voltage, 0, one.d, 6)
    return most_of_pair(one.ramp_current, 0, one.d, 8)


@compiled
def _information(one: Candidate, pair: int) -> tuple[float, float, float]:
    """Return the information on a pair of columns, its elements 00, 01, 11."""
    if pair < 2:
        k = 2 * pair
        return one.step[k, k], one.step[k, k + 1], one.step[k + 1, k + 1]
    if pair == 2:
        return one.impedance[0, 0], one.impedance[0, 1], one.impedance[1, 1]
    if pair == 3:
        return one.ramp_voltage[0, 0], one.ramp_voltage[0, 1], one.ramp_voltage[1, 1]
    return one.ramp_current[0, 0], one.ramp_current[0, 1], one.ramp_current[1, 1]
