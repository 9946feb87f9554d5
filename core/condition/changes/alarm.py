"""A change that the detector has raised: naming it, and how large it is."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import erfc, hypot, log, sqrt
from typing import Any, Final

import numpy as np

from core.condition.changes.evidence import Learnt, along, learnt_without, of_size, signature
from core.condition.changes.hypotheses import CAUSES, LEVEL, Cause, Hypotheses
from core.condition.changes.naming import SIZES, name, probabilities
from core.condition.filter.levels import level_now, levels_since
from core.condition.filter.state import RECENT
from core.condition.kinds import Kind
from core.condition.measuring.signatures import PATHS
from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled

CERTAIN: Final = 0.98
"""Posterior probability at which a cause is named."""
RUNNING: Final = 3
"""Records in a row that have to agree on it."""
SPACED: Final = 8
SELDOM: Final = 32
SETTLED: Final = 64
"""Records after the alarm from which a name is final, and what is no shorted turns is lived with."""
APART: Final = 2.0
"""Standard deviations by which the level of another winding has to be higher to be told instead."""
DRIFT_SHAPE: Final = 0.12
"""Relative standard deviation of the level of a change that drifts: no growth is a straight line, and what
the filter takes up of it before the alarm depends on its course."""
TAIL: Final = 0.025
GRID: Final = 400
WINDOW: Final = 256
"""Records after the alarm within which a cause is named."""

KINDS: Final[Mapping[Cause, Kind]] = {
    Cause.SHORTED_TURNS: Kind.SHORTED_TURNS,
    Cause.VOLTAGE_CHANNEL: Kind.VOLTAGE_CHANNEL,
    Cause.CURRENT_CHANNEL: Kind.CURRENT_CHANNEL,
    Cause.JOINT: Kind.CONNECTION,
    Cause.IMPEDANCE: Kind.PARAMETERS,
}
"""What each cause is told as; another recorder changes voltage and current channels."""

DEFECTS: Final = frozenset((Kind.SHORTED_TURNS, Kind.CONNECTION))
"""Defects of the motor itself and of its joints."""

Names = tuple[Kind, ...]


@dataclass(slots=True)
class Alarm:
    """A change that the detector has raised.

    Parameters
    ----------
    detected_ns : int
        Time of the record with which it was raised, UTC [ns].
    records : int
        Number of records since then.
    named : tuple of Kind
        Kinds that are certain.
    pending : tuple of Kind
        Kinds that the latest records are sure of.
    running : int
        Number of such records in a row.
    surely_above : float
        What the level lay above for certain, once, while it was named as shorted turns. It is looked at until
        it exceeds the motor's limit.
    """

    detected_ns: int
    records: int = 0
    named: Names = ()
    pending: Names = ()
    running: int = 0
    surely_above: float = 0.0

    @property
    def is_to_be_weighed(self) -> bool:
        """Whether the latest record takes part in naming: every one at first, every eighth later."""
        return self.records <= SETTLED or (self.records <= WINDOW and self.records % SPACED == 0)

    def may_be_called(self, limit: float) -> bool:
        """Return whether the latest record may make it a fault that stays one: seldom even much later.

        Parameters
        ----------
        limit : float
            Limit of the motor, a fraction of the phase turns.

        Returns
        -------
        bool
            Whether its level is to be looked at.
        """
        is_looked_at = self.is_to_be_weighed or self.records % SELDOM == 0
        return is_looked_at and self.surely_above <= limit and Kind.SHORTED_TURNS in self.named

    @property
    def is_final(self) -> bool:
        """Whether its name has held for so long that what does not fit it is another change."""
        return bool(self.named) and self.records >= SETTLED

    @property
    def is_to_be_lived_with(self) -> bool:
        """Whether it is no shorted turns for good, so that what comes after it is to be seen by itself."""
        return self.is_final and Kind.SHORTED_TURNS not in self.named


@dataclass(slots=True)
class Weighing:
    """What may have changed, as weighed after one record.

    Parameters
    ----------
    probabilities : ndarray, shape (6,)
        Posterior probability by `Cause`.
    logs : ndarray, shape (places + 2,)
        Log of evidence times prior of every place.
    best : ndarray, shape (places + 2, 5)
        Onset, whether it drifts, size, its deviation and log of evidence that fit every place best.
    """

    probabilities: Array = field(default_factory=lambda: np.zeros(CAUSES))
    logs: Array = field(default_factory=lambda: np.zeros(0))
    best: Array = field(default_factory=lambda: np.zeros((0, 5)))


def weigh(state: Any, bank: Any, hypotheses: Hypotheses, recorder: Array) -> Weighing:
    """Weigh all causes of a change.

    Parameters
    ----------
    state : FilterState
        The filter.
    bank : array of Candidate
        Candidates.
    hypotheses : array of Hypothesis
        All places of all causes.
    recorder : ndarray, shape (4,)
        Standard deviations of the jumps that another recorder makes.

    Returns
    -------
    Weighing
        Their probabilities.
    """
    places = len(hypotheses) + 2
    found = Weighing(logs=np.zeros(places), best=np.zeros((places, 5)))
    name(state, bank, hypotheses, recorder, found.logs, found.best)
    probabilities(hypotheses, found.logs, found.probabilities)
    return found


def confirm(alarm: Alarm, weighing: Weighing) -> None:
    """Name the kind once several records in a row are sure of it.

    Parameters
    ----------
    alarm : Alarm
        The alarm.
    weighing : Weighing
        Weights after the latest record.
    """
    sure = _certain(weighing.probabilities)
    alarm.running = alarm.running + 1 if sure == alarm.pending else 1
    alarm.pending = sure
    if sure and alarm.running >= RUNNING and not _takes_back(alarm, sure):
        alarm.named = sure


def _takes_back(alarm: Alarm, sure: Names) -> bool:
    """Return whether another name would take back a defect of the motor.

    All causes are of one change. After a second one none of them fits, and that with the most freedom, the
    impedance, seems to fit best. A defect that has been named stays named then.
    """
    if not DEFECTS & set(alarm.named):
        return False
    if DEFECTS & set(sure):
        return alarm.is_final and alarm.named == (Kind.SHORTED_TURNS,) and sure == (Kind.CONNECTION,)
    return sure == (Kind.PARAMETERS,) or alarm.is_final


def by_kind(probabilities: Array) -> dict[Kind, float]:
    """Return the probability of each kind.

    Parameters
    ----------
    probabilities : ndarray, shape (6,)
        Posterior probability by `Cause`.

    Returns
    -------
    dict of Kind to float
        Probabilities; they sum to one.
    """
    found = {kind: float(probabilities[cause]) for cause, kind in KINDS.items()}
    half = 0.5 * float(probabilities[Cause.RECORDER])
    found[Kind.VOLTAGE_CHANNEL] += half
    found[Kind.CURRENT_CHANNEL] += half
    return found


def _certain(p: Array) -> Names:
    for cause, kind in KINDS.items():
        if p[cause] >= CERTAIN:
            return (kind,)
    if p[Cause.SHORTED_TURNS] + p[Cause.JOINT] >= CERTAIN:
        return (Kind.SHORTED_TURNS, Kind.CONNECTION)
    if p[Cause.VOLTAGE_CHANNEL] + p[Cause.CURRENT_CHANNEL] + p[Cause.RECORDER] >= CERTAIN:
        return (Kind.VOLTAGE_CHANNEL, Kind.CURRENT_CHANNEL)
    return ()


def taken_up(weighing: Weighing, bank: Any, hypotheses: Hypotheses) -> tuple[Array, Array]:
    """Return what the filter's state has taken up of the likeliest change of a channel, joint or recorder.

    Parameters
    ----------
    weighing : Weighing
        Weights after the latest record.
    bank : array of Candidate
        Candidates.
    hypotheses : array of Hypothesis
        All places of all causes.

    Returns
    -------
    state : ndarray, shape (7,)
        What the state has taken up, f g, of a jump of any direction g.
    covariance : ndarray, shape (7, 7)
        Its covariance, f Lambda^-1 f'.
    """
    turns = hypotheses["cause"] == Cause.SHORTED_TURNS
    logs = np.append(np.where(turns, -np.inf, weighing.logs[:-2]), weighing.logs[-1])
    at = int(np.argmax(logs))
    another = at == len(hypotheses)
    row = weighing.best[at + 1 if another else at]
    one, drifts = bank[int(row[0])], bool(row[1])
    if another or not drifts:
        first = 0 if another else 2 * int(hypotheses[at].column)
        last = 4 if another else first + 2
        information, columns = one.step[first:last, first:last], slice(first, last)
    else:
        current = int(hypotheses[at].column) == 1
        information = one.ramp_current if current else one.ramp_voltage
        columns = slice(8, 10) if current else slice(6, 8)
    spread = np.linalg.pinv(information)
    f = one.f[:, columns]
    return np.asarray(f @ spread @ one.d[columns]), np.asarray(f @ spread @ f.T)


@dataclass(frozen=True, slots=True)
class TurnsLevel:
    """Change of the fault level if the change is shorted turns.

    Parameters
    ----------
    value, deviation : float
        Level now and its standard deviation from all causes.
    interval : tuple of float
        95 % interval.
    winding : int
        Winding of the positive-sequence frame.
    path_ratio : float
        Resistance of the path over that of the shorted turns.
    onset_ns : int
        Time of the first record that likeliest shows it, UTC [ns].
    levels : tuple of tuple of int and float
        Time [ns] and level of each record since then, or of means of several.
    """

    value: float
    deviation: float
    interval: tuple[float, float]
    winding: int
    path_ratio: float
    onset_ns: int
    levels: tuple[tuple[int, float], ...]


def turns_level(
    state: Any, bank: Any, recent: Any, hypotheses: Hypotheses, weighing: Weighing, *, final: bool
) -> TurnsLevel:
    """Return the change of the fault level, should the change be shorted turns.

    Parameters
    ----------
    state : FilterState
        The filter.
    bank : array of Candidate
        Candidates.
    recent : array of Recent
        Latest records.
    hypotheses : array of Hypothesis
        All places of all causes.
    weighing : Weighing
        Weights after the latest record.
    final : bool
        Whether the change is named for good. What another winding shows then is a second change.

    Returns
    -------
    TurnsLevel
        The level, averaged over what the path may be.
    """
    logs = weighing.logs[: 3 * len(PATHS)].reshape(3, len(PATHS))
    likeliest, paths = int(np.argmax(np.logaddexp.reduce(logs, axis=1))), np.argmax(logs, axis=1)
    at = likeliest * len(PATHS) + int(paths[likeliest])
    one, size = bank[int(weighing.best[at, 0])], weighing.best[at, 2]
    drifts = bool(weighing.best[at, 1])
    known = learnt_without(state, one, drifts)
    u, _ = signature(known, hypotheses[at])
    # What the filter has taken up of the change comes off, so that the state is that of before it.
    column = 6 if drifts else 0
    jump = size * np.array([u.real, u.imag])
    before = _Before(
        reference=np.array(state.x) - np.array(one.f)[:, column : column + 2] @ jump,
        one=one,
        drifts=drifts,
        known=known,
    )
    found = _level_in(likeliest, int(paths[likeliest]), state, recent, hypotheses, before)
    if not final:
        return found
    others = (
        _level_in(w, int(paths[w]), state, recent, hypotheses, before) for w in range(3) if w != likeliest
    )
    other = max(others, key=lambda level: level.value)
    apart = other.value - found.value
    return other if apart > APART * hypot(other.deviation, found.deviation) else found


@dataclass(frozen=True, slots=True)
class _Before:
    """The filter as it was before the change, the change's onset, and whether it drifts."""

    reference: Array
    one: Any
    drifts: bool
    known: Learnt


def _level_in(
    winding: int, likeliest: int, state: Any, recent: Any, hypotheses: Hypotheses, before: _Before
) -> TurnsLevel:
    """Return the change of the fault level if it is in one winding; `likeliest` is the path's index."""
    one, drifts, known = before.one, before.drifts, before.known
    shape = DRIFT_SHAPE if drifts else 0.0
    values, spreads = [], []
    told: tuple[tuple[int, float], ...] = ()
    table, out, evidence = np.zeros((RECENT, 3)), np.zeros(5), np.zeros(len(PATHS))
    for p in range(len(PATHS)):
        hypothesis = hypotheses[winding * len(PATHS) + p]
        u, direction = signature(known, hypothesis)
        first = levels_since(state, recent, before.reference, u, one.time_ns, table)
        taken = int(state.recent) - first
        value, wandering = level_now(table[:taken])
        along(one, 0, drifts, u, out)
        evidence[p] = _evidence(out, direction, float(hypothesis.share), int(drifts))
        along(one, 0, False, u, out)  # noqa: FBT003
        a, b, c = out[0], out[1], out[2]
        information = a - b * b / (c + 1.0 / max((direction * value) ** 2, 1e-12))
        values.append(value)
        scale = hypothesis.scale**2 + known[2] ** 2 + shape**2
        spreads.append(wandering + 1.0 / max(information, 1e-9) + scale * value**2)
        if p == likeliest:
            times = [int(recent[first + i].time_ns) for i in range(taken)]
            told = tuple(zip(times, table[:taken, 0].tolist(), strict=True))
    shares = np.exp(evidence - np.max(evidence))
    shares /= shares.sum()
    mean = float(shares @ values)
    variance = float(shares @ (np.array(spreads) + (np.array(values) - mean) ** 2))
    interval = interval_of(shares, np.array(values), np.sqrt(spreads))
    return TurnsLevel(mean, sqrt(variance), interval, winding, PATHS[likeliest], int(one.time_ns), told)


def _evidence(out: Array, direction: float, share: float, drifts: int) -> float:
    """Return the log of the posterior weight of a path: how well its direction fits decides."""
    a, b, c, l0, l1 = out
    usual = LEVEL * (0.5 if drifts else 1.0)
    found = [of_size(a, b, c, l0, l1, k * usual, direction, one_sided=True)[0] for k in SIZES]
    return float(np.logaddexp.reduce(found)) + log(share)


def interval_of(shares: Array, means: Array, deviations: Array) -> tuple[float, float]:
    """Return the 95 % interval of a mixture of normal distributions.

    Parameters
    ----------
    shares, means, deviations : ndarray, shape (n,)
        Weight, mean and standard deviation of each of them.

    Returns
    -------
    tuple of float
        Lower and upper end.
    """
    low, high = float(np.min(means - 5.0 * deviations)), float(np.max(means + 5.0 * deviations))
    return (
        _quantile(TAIL, low, high, shares, means, deviations),
        _quantile(1.0 - TAIL, low, high, shares, means, deviations),
    )


@compiled
def _quantile(share: float, low: float, high: float, shares: Array, means: Array, deviations: Array) -> float:
    """Return the value below which a share of the mixture lies, linear between the points of a grid."""
    step = (high - low) / (GRID - 1)
    first, last = 0, GRID - 1
    before, after = _below(low, shares, means, deviations), _below(high, shares, means, deviations)
    if share <= before:
        return low
    if share >= after:
        return high
    while last - first > 1:
        middle = (first + last) // 2
        below = _below(low + middle * step, shares, means, deviations)
        if below <= share:
            first, before = middle, below
        else:
            last, after = middle, below
    return low + step * (first + (share - before) / (after - before))


@compiled
def _below(value: float, shares: Array, means: Array, deviations: Array) -> float:
    """Return the share of the mixture below a value."""
    found = 0.0
    for n in range(shares.size):
        found += shares[n] * 0.5 * erfc((means[n] - value) / (deviations[n] * sqrt(2.0)))
    return found
