"""What has changed: posterior probabilities of the causes, once the detector has raised an alarm.

The evidence of y, of the side channels and of the current beside its circle is joined. A cause that shows in
one of them has to be seen there with its size; another cause leaves it at rest, but for a coincidence.
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
from core.condition.changes.hypotheses import CAUSES, FREE, IMPEDANCE, WEIGHTS, Cause, Hypothesis
from core.condition.filter.change_bank import RAMP_LENGTH
from core.condition.filter.circle import JUMP, LOAD, along_circle, circle_without
from core.condition.filter.state import BUS, I0, SIDES, TURNS, V0, V2, Candidate, FilterState
from core.condition.measuring.turns_grid import LEVELS
from core.diagnosis.priors import MISFIT
from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled

Y_COUNTS = 600.0
"""Evidence that y counts at most: no model is exact enough to be more certain than that."""
SIDE_COUNTS = 20.0
"""The same of a side channel."""
CIRCLE_COUNTS = 100.0
"""The same of the current beside its circle."""
COINCIDENCES = (0.005, 0.001, 0.02, 0.0005)
"""Probability that V0, I0, v2 or the bus difference jumps by chance at the same time."""
BESIDE_BY_CHANCE = 0.0005
"""The same of the current beside its circle."""
SHOWN_BY_IMPEDANCE = 0.5
"""Probability that another impedance shows there too."""
LOAD_IMPEDANCE = 0.4
"""Standard deviation of what the Z2 of another load makes of the motor's over |Z2|."""
SIDE_JUMP = 0.0065
"""Standard deviation of such a jump (complex magnitude)."""
HIDDEN_STEP, HIDDEN_DRIFT, HIDDEN_WITH_V0, HIDDEN_WITH_BUS = 0.005, 0.2, 0.02, 1e-4
"""Probability that a change of a voltage channel is not seen in V0 and v2: a step, a drift of which only v2
could tell, a drift where V0 is measured, and any where the bus could tell."""
NOTHING = -1e300
NEGLIGIBLE = 10.0
"""Onsets with so much less evidence in y than the best are left out."""
LEAST_SIZE = 1e-3
SIZES = (1.0, 4.0)
"""Multiples of a cause's usual size that are tried."""

_FIRST_LEVEL = float(log(LEVELS[0]))
_LEVEL_STEP = float(log(LEVELS[1] / LEVELS[0]))
_OF_Y, _OF_CIRCLE = SIDES, SIDES + 1
_TURNS = int(Cause.SHORTED_TURNS)
_VOLTAGE = int(Cause.VOLTAGE_CHANNEL)
_LOG_3 = log(3.0)
TINY = 1e-300


@compiled
def name(
    filters: list[FilterState],
    bank: list[Candidate],
    hypotheses: list[Hypothesis],
    level_shares: Array,
    jumps: Array,
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
    level_shares : ndarray, shape (levels, nodes)
        Probability of each axis and leakage of shorted turns at each level.
    jumps : ndarray, shape (6,)
        Standard deviations of the jumps that are free; see `Expectations`.
    logs : ndarray, shape (places + FREE,)
        Filled with the log of the evidence times the prior of every place, and of the free causes.
    best : ndarray, shape (places + FREE, 5)
        Filled with what fits each best: candidate, whether it drifts, size, its deviation, log of evidence.
    """
    state, places = filters[0], len(hypotheses)
    logs[:] = NOTHING
    best[:] = 0.0
    best[:, 4] = NOTHING
    temper, out, joint = np.ones(SIDES + 2), np.zeros(5), np.zeros(5)
    most = _temper(state, bank, temper)
    still = np.zeros(SIDES + 2)
    for i in range(int(state.candidates)):
        one = bank[i]
        if _most_of_y(one) < most - NEGLIGIBLE / temper[_OF_Y]:
            continue
        for drifts in range(2):
            known = learnt_without(state, one, drifts == 1)
            for s in range(SIDES):
                still[s] = _still(one, s, drifts, temper[s])
            free = circle_without(one, drifts == 1, temper[_OF_CIRCLE], JUMP)
            still[_OF_CIRCLE] = log_add(log(1.0 - BESIDE_BY_CHANCE), log(BESIDE_BY_CHANCE) + free)
            grown = (state.records - one.onset) / RAMP_LENGTH if drifts == 1 else 1.0
            for h in range(places):
                _weigh_place(
                    known, one, i, drifts, grown, h, hypotheses[h], level_shares, temper, still, out, joint,
                    logs, best,
                )  # fmt: skip
        _weigh_free(one, i, jumps, temper, logs, best)


@compiled
def _temper(state: FilterState, bank: list[Candidate], temper: Array) -> float:
    """Find the powers of the likelihoods of side channels, y and circle; return the most evidence of y."""
    most = np.zeros(SIDES + 2)
    for i in range(int(state.candidates)):
        one = bank[i]
        most[_OF_Y] = max(most[_OF_Y], _most_of_y(one))
        for c in range(2):
            for s in range(SIDES):
                if one.side_information[s, c] > 0.0:
                    d = one.side_d[s, c]
                    most[s] = max(most[s], (d.real**2 + d.imag**2) / one.side_information[s, c])
            most[_OF_CIRCLE] = max(most[_OF_CIRCLE], circle_without(one, c == 1, 1.0, LOAD))
    for s in range(SIDES):
        temper[s] = min(1.0, SIDE_COUNTS / max(most[s], SIDE_COUNTS))
    temper[_OF_Y] = min(1.0, Y_COUNTS / max(most[_OF_Y], Y_COUNTS))
    temper[_OF_CIRCLE] = min(1.0, CIRCLE_COUNTS / max(most[_OF_CIRCLE], CIRCLE_COUNTS))
    highest: float = most[_OF_Y]
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
def log_share(level: float, node: int, level_shares: Array) -> float:
    """Return the log of the probability of an axis and a leakage at a level.

    Parameters
    ----------
    level : float
        Equivalent level; of none at all that of the lowest counts.
    node : int
        The axis and leakage.
    level_shares : ndarray, shape (levels, nodes)
        Probability of each node at each of LEVELS.

    Returns
    -------
    float
        Log of the probability.
    """
    last = level_shares.shape[0] - 1
    at = 0.0
    if level > 0.0:
        at = min(max((log(level) - _FIRST_LEVEL) / _LEVEL_STEP, 0.0), float(last))
    below = min(int(at), last - 1)
    part = at - below
    share = (1.0 - part) * level_shares[below, node] + part * level_shares[below + 1, node]
    return log(max(share, TINY))


@compiled
def _weigh_place(
    known: Learnt, one: Candidate, i: int, drifts: int, grown: float, h: int, it: Hypothesis,
    level_shares: Array, temper: Array, still: Array, out: Array, joint: Array, logs: Array, best: Array,
) -> None:  # fmt: skip
    """Add the evidence of one onset, as a step or a drift, for one place of a cause.

    In `out` and `joint` it works: what y tells, and what y and all else tell together.
    """
    u, direction = signature(known, it)
    along(one, it.column, drifts == 1, u, out)
    for k in range(5):
        out[k] *= temper[_OF_Y]
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
    usual = 0.0
    if it.cause == _TURNS:
        usual, misfit = along_turns(one, drifts == 1, it.current, temper[_OF_CIRCLE], joint)
        others += misfit
    else:
        usual = max(out[3] / max(out[0], TINY), 0.1 * it.spread)
        along_circle(one, drifts == 1, it.current_column, it.current, temper[_OF_CIRCLE], joint)
    prior = log(0.5 * one.weight)
    for k in range(2):
        spread = SIZES[k] * it.spread * (0.5 if drifts == 1 else 1.0)
        # Turns and joints lie beside their signature by a share of their size, not of the usual one.
        astray = direction * usual / spread if it.one_sided else direction
        evidence, size, deviation = of_size(
            joint[0], joint[1], joint[2], joint[3], joint[4], spread, astray, it.one_sided
        )
        evidence += others
        if it.cause == _VOLTAGE:
            hidden = HIDDEN_DRIFT if drifts == 1 else HIDDEN_STEP
            if drifts == 1 and one.side_information[V0, drifts] > 0.0:
                hidden = HIDDEN_WITH_V0
            if one.side_information[BUS, drifts] > 0.0:
                hidden = HIDDEN_WITH_BUS
            alone, _, _ = of_size(out[0], out[1], out[2], out[3], out[4], spread, direction, it.one_sided)
            unseen = still[V0] + still[V2] + still[I0] + still[BUS] + still[_OF_CIRCLE]
            evidence = log_add(log(1.0 - hidden) + evidence, log(hidden) + alone + unseen)
        share = log(it.share)
        if it.cause == _TURNS:
            share = log_share(grown * size, it.node, level_shares) - _LOG_3
        evidence += prior + share + log(0.5)
        logs[h] = log_add(logs[h], evidence)
        if evidence > best[h, 4]:
            best[h, 0], best[h, 1], best[h, 2], best[h, 3], best[h, 4] = i, drifts, size, deviation, evidence


@compiled
def along_turns(
    one: Candidate, drifts: bool, current: complex, power: float, out: Array
) -> tuple[float, float]:
    """Add what the current shows of shorted turns to what y says of their size.

    The error of the direction is one of y alone. The signature s does not quite fit: the jump is m s + h, and
    h has the variance t = (MISFIT m |s|)^2 each part. With M = (Lambda + I/t)^-1

        a += s' (Lambda - Lambda M Lambda) s,  l += s' (I - Lambda M) d,
        evidence d' M d / 2 - ln det(I + t Lambda) / 2

    Parameters
    ----------
    one : Candidate
        The candidate.
    drifts : bool
        Whether it drifts.
    current : complex
        Signature in z I1/V1.
    power : float
        Weight of the information.
    out : ndarray, shape (5,)
        Information and vector of y; they grow.

    Returns
    -------
    size : float
        Size that y says, not below LEAST_SIZE.
    evidence : float
        What the misfit alone explains.
    """
    size = max(out[3] / max(out[0], 1.0), LEAST_SIZE)
    at = 1 if drifts else 0
    information, d = one.circle_information[at, TURNS], one.circle_d[at]
    p, q, r = power * information[0], power * information[1], power * information[2]
    d0, d1 = power * d[0], power * d[1]
    s0, s1 = current.real, current.imag
    t = (MISFIT * size) ** 2 * (s0 * s0 + s1 * s1)
    P, Q, R = 1.0 + t * p, t * q, 1.0 + t * r
    determinant = P * R - Q * Q
    # M = t (I + t Lambda)^-1; Lambda s and M Lambda s
    v0, v1 = p * s0 + q * s1, q * s0 + r * s1
    w0, w1 = t * (R * v0 - Q * v1) / determinant, t * (P * v1 - Q * v0) / determinant
    out[0] += s0 * v0 + s1 * v1 - v0 * w0 - v1 * w1
    out[3] += s0 * d0 + s1 * d1 - w0 * d0 - w1 * d1
    explained = t * (R * d0 * d0 - 2.0 * Q * d0 * d1 + P * d1 * d1) / determinant
    return size, 0.5 * explained - 0.5 * log(determinant)


@compiled
def _weigh_free(one: Candidate, i: int, jumps: Array, temper: Array, logs: Array, best: Array) -> None:
    """Add the evidence of one onset for another impedance, another recorder, an unknown asymmetry."""
    at = logs.shape[0] - FREE
    power = temper[_OF_Y]
    for drifts in range(2):
        still = free = 0.0
        for s in range(SIDES):
            still += _still(one, s, drifts, temper[s])
            information, vector = one.side_information[s, drifts], one.side_d[s, drifts]
            free += of_free_side(temper[s] * information, temper[s] * vector, SIDE_JUMP)
        beside = circle_without(one, drifts == 1, temper[_OF_CIRCLE], JUMP)
        by_chance = log_add(log(1.0 - BESIDE_BY_CHANCE), log(BESIDE_BY_CHANCE) + beside)
        if drifts == 0:
            either = log_add(log(1.0 - SHOWN_BY_IMPEDANCE), log(SHOWN_BY_IMPEDANCE) + beside)
            impedance = of_free(power * one.impedance, power * one.d[4:6], np.full(2, IMPEDANCE))
            another = of_free(power * one.step, power * one.d[0:4], jumps[0:4])
            _add(at, impedance + still + either + log(one.weight), i, drifts, logs, best)
            _add(at + 1, another + free + beside + log(one.weight), i, drifts, logs, best)
        information = one.step[0:2, 0:2] if drifts == 0 else one.ramp_voltage
        vector = one.d[0:2] if drifts == 0 else one.d[6:8]
        spreads = np.full(2, jumps[5] * (0.5 if drifts == 1 else 1.0))
        jump = of_free(power * information, power * vector, spreads) + still
        _add(at + 2, jump + by_chance + log(0.5 * one.weight), i, drifts, logs, best)
        if drifts == 0:
            # Its negative-sequence current is in proportion to V2, and its own asymmetry to V1.
            loaded = of_free(power * one.impedance, power * one.d[4:6], np.full(2, LOAD_IMPEDANCE))
            either = log_add(loaded + still, jump) + log(0.5)
            beside = circle_without(one, False, temper[_OF_CIRCLE], LOAD)  # noqa: FBT003
            _add(at + 3, either + beside + log(one.weight), i, drifts, logs, best)


@compiled
def _add(at: int, evidence: float, i: int, drifts: int, logs: Array, best: Array) -> None:
    """Add the evidence of one onset for a free cause."""
    logs[at] = log_add(logs[at], evidence)
    if evidence > best[at, 4]:
        best[at, 0], best[at, 1], best[at, 4] = i, drifts, evidence


@compiled
def probabilities(hypotheses: list[Hypothesis], logs: Array, out: Array) -> None:
    """Return the posterior probability of each cause.

    Parameters
    ----------
    hypotheses : array of Hypothesis
        All places of all causes.
    logs : ndarray, shape (places + FREE,)
        What `name` filled.
    out : ndarray, shape (9,)
        Filled with probabilities by `Cause`.
    """
    places = len(hypotheses)
    sums = np.full(CAUSES, NOTHING)
    for h in range(places):
        cause = hypotheses[h].cause
        sums[cause] = log_add(sums[cause], logs[h])
    for k in range(FREE):
        sums[CAUSES - FREE + k] = logs[places + k]
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
