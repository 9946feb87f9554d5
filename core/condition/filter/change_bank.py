"""Bank of changes that may have begun with some record, after Willsky and Jones.

A jump of size g that began with record theta adds J g to y. The filter that knows nothing of it takes up
f g of it, so that its innovation is nu + G g with G = J - H f, and f grows by K G. Information on g adds up
over the records: Lambda += G' S^-1 G, d += G' S^-1 nu. Nothing is approximated.

Columns of J: 1, j, j1, j j1, j2, j j2 for jumps, ramp (1, j, j1, j j1) for drifts.

References
----------
A. S. Willsky, H. L. Jones, "A generalized likelihood ratio approach to the detection and estimation of jumps
in linear systems", IEEE Trans. Automatic Control 21 (1976), 108-112.
"""

import numpy as np

from core.condition.filter.circle import fold_circle_candidate
from core.condition.filter.kalman import STATES
from core.condition.filter.state import CANDIDATES, SIDES, Candidate, CircleState, FilterState, SideState
from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled

COLUMNS = 10
RAMP_LENGTH = 32.0
"""Records after which a drift counts as large as its size."""
OLDEST = 400.0
"""Records after which an onset is no longer looked for."""


@compiled
def add_candidate(state: FilterState, bank: list[Candidate], time_ns: int) -> None:
    """Let a change begin with the next record; join two older onsets where there are too many.

    Parameters
    ----------
    state : FilterState
        The filter, before that record.
    bank : array of Candidate
        Candidates, oldest first.
    time_ns : int
        Time of the record, UTC [ns].
    """
    count = int(state.candidates)
    if count > 0 and state.records - bank[0].onset > OLDEST:
        _remove(bank, 0, count)
        count -= 1
    if count == CANDIDATES:
        joined = _most_alike(bank, count, state.records)
        bank[joined - 1].weight += bank[joined].weight
        _remove(bank, joined, count)
        count -= 1
    new = bank[count]
    new.time_ns, new.onset, new.weight = time_ns, state.records, 1.0
    new.f[:] = 0.0
    new.step[:] = 0.0
    new.impedance[:] = 0.0
    new.ramp_voltage[:] = 0.0
    new.ramp_current[:] = 0.0
    new.d[:] = 0.0
    new.side_f[:] = 0.0
    new.side_information[:] = 0.0
    new.side_d[:] = 0.0
    new.circle_f[:] = 0.0
    new.circle_information[:] = 0.0
    new.circle_d[:] = 0.0
    state.candidates = count + 1.0


@compiled
def fold_candidates(
    state: FilterState, bank: list[Candidate], sides: list[SideState], circle: CircleState, rho: float
) -> None:
    """Let one record tell of every candidate.

    Parameters
    ----------
    state : FilterState
        The filter, after the record's update.
    bank : array of Candidate
        Candidates.
    sides : array of SideState
        Side channels, after the record.
    circle : CircleState
        Filter of the current beside its circle, after the record.
    rho : float
        By how much temperature has faded since the record before.
    """
    H, K, Si, nu = state.H, state.K, state.S_inverse, state.nu
    J, G, W = np.zeros((2, COLUMNS)), np.zeros((2, COLUMNS)), np.zeros((2, COLUMNS))
    for i in range(int(state.candidates)):
        one = bank[i]
        ramp = (state.records - one.onset + 1.0) / RAMP_LENGTH
        f = one.f
        for c in range(COLUMNS):
            f[STATES - 1, c] *= rho
        _seen(H, f, ramp, J, G)
        for c in range(COLUMNS):
            W[0, c] = Si[0, 0] * G[0, c] + Si[0, 1] * G[1, c]
            W[1, c] = Si[1, 0] * G[0, c] + Si[1, 1] * G[1, c]
            one.d[c] += W[0, c] * nu[0] + W[1, c] * nu[1]
            for k in range(STATES):
                f[k, c] += K[k, 0] * G[0, c] + K[k, 1] * G[1, c]
        _add_block(one.step, G, W, 0)
        _add_block(one.impedance, G, W, 4)
        _add_block(one.ramp_voltage, G, W, 6)
        _add_block(one.ramp_current, G, W, 8)
        for s in range(SIDES):
            if sides[s].S > 0.0:
                _fold_side_candidate(one, s, sides[s], ramp)
        fold_circle_candidate(one, circle, ramp)


@compiled
def _seen(H: Array, f: Array, ramp: float, J: Array, G: Array) -> None:
    """Compute G = J - H f."""
    for r in range(2):
        for c in range(6):
            J[r, c] = H[r, c]
        for c in range(4):
            J[r, 6 + c] = ramp * H[r, c]
        for c in range(COLUMNS):
            total = J[r, c]
            for k in range(STATES):
                total -= H[r, k] * f[k, c]
            G[r, c] = total


@compiled
def _add_block(block: Array, G: Array, W: Array, first: int) -> None:
    size = block.shape[0]
    for a in range(size):
        for b in range(size):
            block[a, b] += G[0, first + a] * W[0, first + b] + G[1, first + a] * W[1, first + b]


@compiled
def _fold_side_candidate(one: Candidate, s: int, side: SideState, ramp: float) -> None:
    for c in range(2):
        jump = 1.0 if c == 0 else ramp
        G = jump - one.side_f[s, 0, c] - side.regressor * one.side_f[s, 1, c]
        one.side_information[s, c] += (G.real**2 + G.imag**2) / side.S
        one.side_d[s, c] += G.conjugate() * side.nu / side.S
        one.side_f[s, 0, c] += side.K[0] * G
        one.side_f[s, 1, c] += side.K[1] * G


@compiled
def _most_alike(bank: list[Candidate], count: int, now: float) -> int:
    """Return the onset whose neighbours are nearest to one another in log of age; not the two newest."""
    best, least = 1, 1e300
    for i in range(1, count - 1):
        ratio = (now - bank[i - 1].onset + 1.0) / (now - bank[i + 1].onset + 1.0)
        if ratio < least:
            best, least = i, ratio
    return best


@compiled
def _remove(bank: list[Candidate], index: int, count: int) -> None:
    for i in range(index, count - 1):
        bank[i] = bank[i + 1]
