"""A change that is taken into what stands, whatever it is, so that the next one is seen by itself.

The filter is blind to a change: it has taken up f g of the jump J g. Where the errors themselves have jumped
by g, they are x + (I - f) g, with the information Lambda and d on g that the bank has. That is exact for a
step. A drift that goes on is a wander of its slope from then on.
"""

import numpy as np

from core.condition.changes.before_change import likeliest_jump
from core.condition.changes.evidence import most_of_pair
from core.condition.filter.change_bank import RAMP_LENGTH
from core.condition.filter.circle import take_in_circle
from core.condition.filter.kalman import STATES
from core.condition.filter.state import SIDES, Candidate, CircleState, FilterState, SideState
from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled

JUMP = 0.1
"""Standard deviation of each part of a jump of E and C before: nothing is said of what it is."""
SIDE_JUMP = 0.02
"""The same in a side channel (complex magnitude)."""
DRIFT_GOES_ON = 4.0
"""Standard deviation of a drift's wander from record to record over its slope: one that goes on, slower or
faster, is no second change."""


@compiled
def take_in(
    filters: list[FilterState], bank: list[Candidate], sides: list[SideState], circles: list[CircleState]
) -> None:
    """Take the likeliest change into the standing errors; no onset is left in the bank.

    Parameters
    ----------
    filters : array of FilterState, shape (1,)
        The filter; it changes.
    bank : array of Candidate
        Candidates.
    sides : array of SideState
        Side channels; they change.
    circles : array of CircleState, shape (1,)
        Filter of the current beside its circle; it changes.
    """
    state = filters[0]
    at, column = likeliest_jump(state, bank)
    if at >= 0:
        one = bank[at]
        ramp = (state.records - one.onset) / RAMP_LENGTH
        if column == 4:
            _add_jump(state, one.f[:, 4:6].copy(), one.impedance, one.d[4:6].copy(), 4, 1.0)
        elif column < 6:
            _add_jump(state, one.f[:, 0:4].copy(), one.step, one.d[0:4].copy(), 0, 1.0)
        else:
            block = one.ramp_voltage if column == 6 else one.ramp_current
            taken, vector = one.f[:, column : column + 2].copy(), one.d[column : column + 2].copy()
            _add_jump(state, taken, block, vector, column - 6, ramp)
        _let_drift(state, one)
        for s in range(SIDES):
            _add_to_side(sides[s], one, s)
        take_in_circle(circles[0], one)
    state.candidates, state.recent, state.block = 0.0, 0.0, 1.0
    state.statistic = 0.0


@compiled
def _add_jump(state: FilterState, f: Array, information: Array, d: Array, first: int, shape: float) -> None:
    """Let the states from `first` on have jumped: x += T g, P += T M T' with T = I - f."""
    n = d.shape[0]
    M = np.linalg.inv(information + np.eye(n) / JUMP**2)
    T = -f
    for k in range(n):
        T[first + k, k] += shape
    moved = T @ (M @ d)
    spread = T @ M @ T.T
    for i in range(STATES):
        state.x[i] += moved[i]
        for j in range(STATES):
            state.P[i, j] += spread[i, j]


@compiled
def _let_drift(state: FilterState, one: Candidate) -> None:
    """Let E and C wander by the slope of a drift, as far as it is one."""
    evidence = np.zeros(4)
    for k in range(2):
        evidence[k] = most_of_pair(one.step, 2 * k, one.d, 2 * k)
    evidence[2] = most_of_pair(one.ramp_voltage, 0, one.d, 6)
    evidence[3] = most_of_pair(one.ramp_current, 0, one.d, 8)
    shares = np.exp(evidence - evidence.max())
    shares /= shares.sum()
    for k in range(2):
        block, column = (one.ramp_voltage, 6) if k == 0 else (one.ramp_current, 8)
        g = np.linalg.inv(block + np.eye(2) / JUMP**2) @ one.d[column : column + 2].copy()
        slope2 = 0.5 * (g[0] ** 2 + g[1] ** 2) / RAMP_LENGTH**2
        variance = DRIFT_GOES_ON**2 * shares[2 + k] * slope2
        if k == 0:
            state.drift_E += variance
        else:
            state.drift_C += variance


@compiled
def _add_to_side(side: SideState, one: Candidate, s: int) -> None:
    """Let a side channel's level have jumped."""
    information = one.side_information[s, 0]
    if information <= 0.0:
        return
    M = 1.0 / (information + 1.0 / SIDE_JUMP**2)
    g = M * one.side_d[s, 0]
    T0, T1 = 1.0 - one.side_f[s, 0, 0], -one.side_f[s, 1, 0]
    side.x[0] += T0 * g
    side.x[1] += T1 * g
    side.P[0, 0] += M * (T0 * T0.conjugate()).real
    side.P[1, 1] += M * (T1 * T1.conjugate()).real
    side.P[0, 1] += M * T0 * T1.conjugate()
    side.P[1, 0] += M * T1 * T0.conjugate()
