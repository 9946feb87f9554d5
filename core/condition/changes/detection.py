"""Whether anything has changed: the detector of Shiryaev and Roberts, summed over all that may have changed.

    R = sum over onsets of half the mean evidence for shorted turns and half that for any cause

Without a change R less the number of records is a martingale, so that E[R] is at most that number and the
mean run length to a false alarm at least the threshold: e^h records, h = ln(records in 1,000 motor-years).

References
----------
M. Pollak, "Optimal detection of a change in distribution", Annals of Statistics 13 (1985), 206-227.
"""

from math import exp, log

import numpy as np

from core.condition.changes.evidence import along, learnt_without, most_of_pair, of_free, of_size, signature
from core.condition.changes.hypotheses import IMPEDANCE, WEIGHTS, Cause, Hypothesis
from core.condition.filter.state import Candidate, FilterState
from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled

MOTOR_YEARS = 1_000.0
"""Mean run length to a false alarm."""
YEAR_S = 365.25 * 86400.0
SHORTEST_GAP_S, LONGEST_GAP_S = 60.0, 86400.0
"""Gaps between records, beyond which the run length counts as at them."""
GAP_MEMORY = 256.0
NEGLIGIBLE = 3.0
"""Evidence that is left out of the sum: it is too small to matter, and R only gets smaller."""
LARGEST = 500.0
"""Evidence beyond which more makes no difference."""
HALF = 0.5

_TOTAL_WEIGHT = sum(WEIGHTS)
_W_ASYMMETRY = HALF * WEIGHTS[Cause.ASYMMETRY] / _TOTAL_WEIGHT
_W_TURNS = HALF + HALF * WEIGHTS[Cause.SHORTED_TURNS] / _TOTAL_WEIGHT
_W_CHANNEL = HALF * WEIGHTS[Cause.VOLTAGE_CHANNEL] / _TOTAL_WEIGHT
_W_RARE = HALF * WEIGHTS[Cause.RECORDER] / _TOTAL_WEIGHT
_TURNS = int(Cause.SHORTED_TURNS)
_ELEMENT = int(Cause.ELEMENT)


@compiled
def learn_gap(state: FilterState, elapsed_s: float) -> None:
    """Learn the mean time between records, from which the threshold follows.

    Parameters
    ----------
    state : FilterState
        The filter.
    elapsed_s : float
        Time since the record before [s].
    """
    bounded = min(max(elapsed_s, SHORTEST_GAP_S), LONGEST_GAP_S)
    if state.gap_s == 0.0:
        state.gap_s = bounded
    gain = max(1.0 / (state.records + 1.0), 1.0 / GAP_MEMORY)
    state.gap_s += gain * (bounded - state.gap_s)
    state.threshold = log(MOTOR_YEARS * YEAR_S / state.gap_s)


@compiled
def detect(state: FilterState, bank: list[Candidate], hypotheses: list[Hypothesis], jumps: Array) -> None:
    """Compute the detector's statistic after a record.

    Parameters
    ----------
    state : FilterState
        The filter.
    bank : array of Candidate
        Candidates.
    hypotheses : array of Hypothesis
        All places of all causes.
    jumps : ndarray, shape (6,)
        Standard deviations of the jumps that are free; see `Expectations`.
    """
    total = 0.0
    free = np.full(2, IMPEDANCE)
    for i in range(int(state.candidates)):
        one = bank[i]
        total += one.weight * _of_candidate(state, one, hypotheses, free, jumps)
    state.statistic = log(max(total, 1.0))


@compiled
def _of_candidate(
    state: FilterState, one: Candidate, hypotheses: list[Hypothesis], free: Array, jumps: Array
) -> float:
    """Return the mean Bayes factor of one onset, its negligible parts left out.

    With their axis and leakage, shorted turns show in nearly any direction: here in any.
    """
    total = 0.0
    most = np.zeros((2, 2))
    most[0, 0] = most_of_pair(one.step, 0, one.d, 0)
    most[0, 1] = most_of_pair(one.ramp_voltage, 0, one.d, 6)
    most[1, 0] = most_of_pair(one.step, 2, one.d, 2)
    most[1, 1] = most_of_pair(one.ramp_current, 0, one.d, 8)
    out = np.zeros(5)
    for drifts in range(2):
        if max(most[0, drifts], most[1, drifts]) < NEGLIGIBLE:
            continue
        known = learnt_without(state, one, drifts == 1)
        if most[0, drifts] >= NEGLIGIBLE:
            information = one.step[0:2, 0:2] if drifts == 0 else one.ramp_voltage
            vector = one.d[0:2] if drifts == 0 else one.d[6:8]
            total += HALF * _free(information, vector, jumps, drifts)
        for h in range(len(hypotheses)):
            it = hypotheses[h]
            if it.cause == _TURNS:
                break
            if it.cause == _ELEMENT:  # it shows in y as an asymmetry does
                continue
            if most[it.column, drifts] < NEGLIGIBLE:
                continue
            u, direction = signature(known, it)
            along(one, it.column, drifts == 1, u, out)
            spread = it.spread if drifts == 0 else HALF * it.spread
            evidence, _, _ = of_size(out[0], out[1], out[2], out[3], out[4], spread, direction, it.one_sided)
            total += HALF * _W_CHANNEL * it.share * exp(min(evidence, LARGEST))
    if most_of_pair(one.impedance, 0, one.d, 4) > NEGLIGIBLE:
        total += _W_RARE * exp(min(of_free(one.impedance, one.d[4:6], free), LARGEST))
    if max(most[0, 0], most[1, 0]) > NEGLIGIBLE:
        total += _W_RARE * exp(min(of_free(one.step, one.d[0:4], jumps[0:4]), LARGEST))
    return total


@compiled
def _free(information: Array, vector: Array, jumps: Array, drifts: int) -> float:
    """Return the weighted Bayes factors of shorted turns and of an asymmetry of unknown cause in y."""
    shape = HALF if drifts == 1 else 1.0
    total = 0.0
    for k in range(2):
        weight = _W_TURNS if k == 0 else _W_ASYMMETRY
        spreads = np.full(2, shape * jumps[4 + k])
        total += weight * exp(min(of_free(information, vector, spreads), LARGEST))
    return total
