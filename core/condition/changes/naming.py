"""What has changed: posterior probabilities of the causes, once the detector has raised an alarm.

The evidence of y and of the side channels is joined. A cause that shows in a side channel has to be seen
there with its size; another cause leaves the side channel at rest, but for a coincidence.
"""

from math import exp, log

import numpy as np

from core.condition.changes.evidence import (
    Learnt,
    along,
    learnt_without,
    log_add,
    most_of_pair,
    of_free,
    of_free_side,
    of_size,
    signature,
)
from core.condition.changes.hypotheses import CAUSES, IMPEDANCE, WEIGHTS, Cause, Hypothesis
from core.condition.filter.state import BUS, I0, SIDES, V0, V2, Candidate, FilterState
from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled

Y_COUNTS = 150.0
"""Evidence that y counts at most: no model is exact enough to be more certain than that."""
SIDE_COUNTS = 20.0
"""The same of a side channel."""
COINCIDENCES = (0.005, 0.001, 0.02, 0.0005)
"""Probability that V0, I0, v2 or the bus difference jumps by chance at the same time."""
SIDE_JUMP = 0.0065
"""Standard deviation of such a jump (complex magnitude)."""
HIDDEN_STEP, HIDDEN_DRIFT, HIDDEN_WITH_V0, HIDDEN_WITH_BUS = 0.005, 0.2, 0.02, 1e-4
"""Probability that a change of a voltage channel is not seen in V0 and v2: a step, a drift of which only v2
could tell, a drift where V0 is measured, and any where the bus could tell."""
NOTHING = -1e300
NEGLIGIBLE = 30.0
"""Onsets with so much less evidence in y than the best are left out."""
SIZES = (1.0, 4.0)
"""Multiples of a cause's usual size that are tried."""

_VOLTAGE = int(Cause.VOLTAGE_CHANNEL)
_CURRENT = int(Cause.CURRENT_CHANNEL)


@compiled
def name(
    filters: list[FilterState],
    bank: list[Candidate],
    hypotheses: list[Hypothesis],
    recorder: Array,
    logs: Array,
    best: Array,
) -> None:
    """Weigh all causes.

    Parameters
    ----------
    filters : array of FilterState, shape (1,)
        The filter.
    bank : array of Candidate
        Candidates.
    hypotheses : array of Hypothesis
        All places of all causes.
    recorder : ndarray, shape (4,)
        Standard deviations of the jumps that another recorder makes.
    logs : ndarray, shape (places + 2,)
        Filled with the log of the evidence times the prior of every place, of the impedance and the recorder.
    best : ndarray, shape (places + 2, 5)
        Filled with what fits each best: candidate, whether it drifts, size, its deviation, log of evidence.
    """
    state, places = filters[0], len(hypotheses)
    logs[:] = NOTHING
    best[:] = 0.0
    best[:, 4] = NOTHING
    temper, out, joint = np.ones(SIDES + 1), np.zeros(5), np.zeros(5)
    most = _temper(state, bank, temper)
    for i in range(int(state.candidates)):
        one = bank[i]
        if _most_of_y(one) < most - NEGLIGIBLE / temper[SIDES]:
            continue
        for drifts in range(2):
            known = learnt_without(state, one, drifts == 1)
            still = np.zeros(SIDES)
            for s in range(SIDES):
                still[s] = _still(one, s, drifts, temper[s])
            for h in range(places):
                _weigh_place(known, one, i, drifts, h, hypotheses[h], temper, still, out, joint, logs, best)
        _weigh_free(one, i, recorder, temper, logs, best)


@compiled
def _temper(state: FilterState, bank: list[Candidate], temper: Array) -> float:
    """Find the powers of the likelihoods of side channels and of y; return the most evidence of y."""
    most = np.zeros(SIDES + 1)
    for i in range(int(state.candidates)):
        one = bank[i]
        most[SIDES] = max(most[SIDES], _most_of_y(one))
        for s in range(SIDES):
            for c in range(2):
                if one.side_information[s, c] > 0.0:
                    d = one.side_d[s, c]
                    most[s] = max(most[s], (d.real**2 + d.imag**2) / one.side_information[s, c])
    for s in range(SIDES):
        temper[s] = min(1.0, SIDE_COUNTS / max(most[s], SIDE_COUNTS))
    temper[SIDES] = min(1.0, Y_COUNTS / max(most[SIDES], Y_COUNTS))
    highest: float = most[SIDES]
    return highest


@compiled
def _most_of_y(one: Candidate) -> float:
    """Return the most evidence that any cause can have from one onset in y."""
    return max(
        most_of_pair(one.step, 0, one.d, 0),
        most_of_pair(one.step, 2, one.d, 2),
        most_of_pair(one.ramp_voltage, 0, one.d, 6),
        most_of_pair(one.ramp_current, 0, one.d, 8),
        most_of_pair(one.impedance, 0, one.d, 4),
    )


@compiled
def _still(one: Candidate, s: int, drifts: int, power: float) -> float:
    """Return the evidence of a side channel for a cause that it does not show."""
    free = of_free_side(power * one.side_information[s, drifts], power * one.side_d[s, drifts], SIDE_JUMP)
    chance = COINCIDENCES[s]
    return log_add(log(1.0 - chance), log(chance) + free)


@compiled
def _weigh_place(
    known: Learnt, one: Candidate, i: int, drifts: int, h: int, it: Hypothesis, temper: Array,
    still: Array, out: Array, joint: Array, logs: Array, best: Array,
) -> None:  # fmt: skip
    """Add the evidence of one onset, as a step or a drift, for one place of a cause.

    In `out` and `joint` it works: what y tells, and what y and the side channels tell together.
    """
    u, direction = signature(known, it)
    along(one, it.column, drifts == 1, u, out)
    for k in range(5):
        out[k] *= temper[SIDES]
        joint[k] = out[k]
    others = 0.0
    for s in range(SIDES):
        shown = it.side[s]
        square = shown.real**2 + shown.imag**2
        if square > 0.0 and one.side_information[s, drifts] > 0.0:
            information = 2.0 * temper[s] * square * one.side_information[s, drifts]
            projected = 2.0 * temper[s] * shown.conjugate() * one.side_d[s, drifts]
            joint[0] += information
            joint[2] += information
            joint[3] += projected.real
            joint[4] += projected.imag
        else:
            others += still[s]
    prior = log(0.5 * one.weight * it.share)
    for k in range(2):
        spread = SIZES[k] * it.spread * (0.5 if drifts == 1 else 1.0)
        evidence, size, deviation = of_size(
            joint[0], joint[1], joint[2], joint[3], joint[4], spread, direction, it.one_sided
        )
        evidence += others
        if it.cause == _VOLTAGE:
            hidden = HIDDEN_DRIFT if drifts == 1 else HIDDEN_STEP
            if drifts == 1 and one.side_information[V0, drifts] > 0.0:
                hidden = HIDDEN_WITH_V0
            if one.side_information[BUS, drifts] > 0.0:
                hidden = HIDDEN_WITH_BUS
            alone, _, _ = of_size(out[0], out[1], out[2], out[3], out[4], spread, direction, it.one_sided)
            unseen = still[V0] + still[V2] + still[I0] + still[BUS]
            evidence = log_add(log(1.0 - hidden) + evidence, log(hidden) + alone + unseen)
        evidence += prior + log(0.5)
        logs[h] = log_add(logs[h], evidence)
        if evidence > best[h, 4]:
            best[h, 0], best[h, 1], best[h, 2], best[h, 3], best[h, 4] = i, drifts, size, deviation, evidence


@compiled
def _weigh_free(one: Candidate, i: int, recorder: Array, temper: Array, logs: Array, best: Array) -> None:
    """Add the evidence of one onset for another impedance and another recorder."""
    at = logs.shape[0] - 2
    power = temper[SIDES]
    still = 0.0
    free = 0.0
    for s in range(SIDES):
        still += _still(one, s, 0, temper[s])
        free += of_free_side(temper[s] * one.side_information[s, 0], temper[s] * one.side_d[s, 0], SIDE_JUMP)
    impedance = of_free(power * one.impedance, power * one.d[4:6], np.full(2, IMPEDANCE)) + still
    another = of_free(power * one.step, power * one.d[0:4], recorder) + free
    for k in range(2):
        evidence = (impedance if k == 0 else another) + log(one.weight)
        logs[at + k] = log_add(logs[at + k], evidence)
        if evidence > best[at + k, 4]:
            best[at + k, 0], best[at + k, 4] = i, evidence


@compiled
def probabilities(hypotheses: list[Hypothesis], logs: Array, out: Array) -> None:
    """Return the posterior probability of each cause.

    Parameters
    ----------
    hypotheses : array of Hypothesis
        All places of all causes.
    logs : ndarray, shape (places + 2,)
        What `name` filled.
    out : ndarray, shape (6,)
        Filled with probabilities by `Cause`.
    """
    places = len(hypotheses)
    sums = np.full(CAUSES, NOTHING)
    for h in range(places):
        cause = hypotheses[h].cause
        sums[cause] = log_add(sums[cause], logs[h])
    sums[CAUSES - 2], sums[CAUSES - 1] = logs[places], logs[places + 1]
    highest = NOTHING
    for c in range(CAUSES):
        sums[c] += log(WEIGHTS[c])
        highest = max(highest, sums[c])
    total = 0.0
    for c in range(CAUSES):
        out[c] = exp(sums[c] - highest)
        total += out[c]
    for c in range(CAUSES):
        out[c] /= total
