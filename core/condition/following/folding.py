"""One record into all that is kept of a motor."""

import numpy as np

from core.condition.changes.before_change import expected
from core.condition.changes.detection import detect, learn_gap
from core.condition.changes.hypotheses import Hypothesis
from core.condition.filter.change_bank import RAMP_LENGTH, add_candidate, fold_candidates
from core.condition.filter.circle import begin_circle, expected_beside, fold_circle
from core.condition.filter.kalman import (
    FIRST_KNOWN,
    learn_noise,
    predict,
    rebalance,
    regressor,
    smooth,
    update,
)
from core.condition.filter.side_channels import begin, fold_side, noise_share_of_currents
from core.condition.filter.state import (
    I0,
    RECENT,
    SIDES,
    V0,
    Candidate,
    CircleState,
    FilterState,
    Recent,
    SideState,
)
from core.condition.measuring.measurement import Measurement
from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled

APART = 16
FIRST_BALANCE = 16.0
"""Records after which the currents' noise is known; it is looked at again after twice as many."""


@compiled
def fold_record(
    filters: list[FilterState], bank: list[Candidate], sides: list[SideState], circles: list[CircleState],
    recent: list[Recent], hypotheses: list[Hypothesis], jumps: Array, record: Measurement, time_ns: int,
    changed: bool,
) -> None:  # fmt: skip
    """Take one record in and look for a change.

    Parameters
    ----------
    filters : array of FilterState, shape (1,)
        The filter. An array is handed to compiled code in a tenth of the time that its record takes.
    bank : array of Candidate
        Candidates.
    sides : array of SideState
        Side channels.
    circles : array of CircleState, shape (1,)
        Filter of the current beside its circle.
    recent : array of Recent
        Latest records.
    hypotheses : array of Hypothesis
        All places of all causes.
    jumps : ndarray, shape (6,)
        Standard deviations of the jumps that are free; see `Expectations`.
    record : Measurement
        The record.
    time_ns : int
        Its time, UTC [ns].
    changed : bool
        Whether a change has been detected: its onsets are kept then, and the noise is no longer learnt.
    """
    state = filters[0]
    rho = predict(state, record.elapsed_s)
    if not changed:
        add_candidate(state, bank, time_ns)
    count = int(state.recent)
    earlier = recent[max(count - APART, 0)].j2 if count > 0 else state.w
    smooth(state, regressor(state, record.y, record.j2), earlier)
    added, at, drifts = (0.0, 0.0), -1, False
    if changed:
        added, at, drifts = expected(state, bank, record.j1, state.w)
    beside = 0.0
    if at >= 0:
        ramp = (state.records - bank[at].onset + 1.0) / RAMP_LENGTH
        beside = expected_beside(bank[at], record.circle, ramp, drifts)
    update(state, record.y, record.j1, state.w, not changed, added)
    for s in range(SIDES):
        fold_side(sides[s], s, record)
    fold_circle(circles[0], record.circle, record.j1, record.elapsed_s, not changed, beside)
    fold_candidates(state, bank, sides, circles[0], rho)
    if not changed:
        learn_noise(state)
        if state.records >= FIRST_BALANCE and np.log2(state.records) % 1.0 == 0.0:
            rebalance(state, noise_share_of_currents(sides[V0], sides[I0], state.s2))
    learn_gap(state, record.elapsed_s)
    detect(state, bank, hypotheses, jumps)
    _remember(state, recent, record, time_ns, changed)
    state.records += 1.0


@compiled
def fold_first(
    filters: list[FilterState], sides: list[SideState], circles: list[CircleState], record: Measurement
) -> None:
    """Take one of the first records in, which nothing can be compared with.

    Parameters
    ----------
    filters : array of FilterState, shape (1,)
        The filter.
    sides : array of SideState
        Side channels.
    circles : array of CircleState, shape (1,)
        Filter of the current beside its circle.
    record : Measurement
        The record.
    """
    state = filters[0]
    predict(state, record.elapsed_s)
    state.w = state.w_raw = regressor(state, record.y, record.j2)
    update(state, record.y, record.j1, state.w, False, (0.0, 0.0))  # noqa: FBT003
    for s in range(SIDES):
        fold_side(sides[s], s, record)
    fold_circle(circles[0], record.circle, record.j1, record.elapsed_s, True, 0.0)  # noqa: FBT003
    learn_gap(state, record.elapsed_s)
    state.records += 1.0


@compiled
def restart(filters: list[FilterState], sides: list[SideState], circles: list[CircleState]) -> None:
    """Begin a reference: forget all but what the filter starts from.

    Parameters
    ----------
    filters : array of FilterState, shape (1,)
        The filter; x0 and P0 are set.
    sides : array of SideState
        Side channels.
    circles : array of CircleState, shape (1,)
        Filter of the current beside its circle; its spread is set.
    """
    state = filters[0]
    state.x[:] = state.x0
    state.P[:] = state.P0
    state.records = state.gap_s = state.candidates = state.recent = 0.0
    state.block = 1.0
    state.noise_known = FIRST_KNOWN
    state.w_near, state.w_far = 0.0, 0.0
    state.statistic = state.surprise = state.log_likelihood = 0.0
    state.drift_E = state.drift_C = 0.0
    for s in range(SIDES):
        begin(sides[s], s)
    begin_circle(circles[0])


@compiled
def _remember(
    state: FilterState, recent: list[Recent], record: Measurement, time_ns: int, changed: bool
) -> None:
    """Keep the record: of a healthy motor the latest ones, after a change all, by means of ever more."""
    count = int(state.recent)
    j2 = state.w
    if count > 0 and recent[count - 1].count < state.block:
        last = recent[count - 1]
        gain = 1.0 / (last.count + 1.0)
        last.y += gain * (record.y - last.y)
        last.j1 += gain * (record.j1 - last.j1)
        last.j2 += gain * (j2 - last.j2)
        last.R += gain * (state.R - last.R)
        last.count += 1.0
        last.time_ns = time_ns
        return
    if count == RECENT:
        if changed:
            count = _halve(recent)
            state.block *= 2.0
        else:
            for i in range(count - 1):
                recent[i] = recent[i + 1]
            count -= 1
    new = recent[count]
    new.time_ns, new.count, new.R = time_ns, 1.0, state.R
    new.y, new.j1, new.j2 = record.y, record.j1, j2
    state.recent = count + 1.0


@compiled
def _halve(recent: list[Recent]) -> int:
    """Join neighbouring entries two by two."""
    for i in range(RECENT // 2):
        a, b, out = recent[2 * i], recent[2 * i + 1], recent[i]
        total = a.count + b.count
        share = b.count / total
        y, j1, j2 = a.y + share * (b.y - a.y), a.j1 + share * (b.j1 - a.j1), a.j2 + share * (b.j2 - a.j2)
        R, time_ns = a.R + share * (b.R - a.R), b.time_ns
        out.y, out.j1, out.j2, out.R, out.count, out.time_ns = y, j1, j2, R, total, time_ns
    return RECENT // 2
