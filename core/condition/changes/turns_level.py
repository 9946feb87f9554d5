"""How large a change is if it is shorted turns: in which winding, and averaged over what the path may be."""

from dataclasses import dataclass
from math import exp, hypot, log, log1p, sqrt
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from core.condition.changes.alarm import Weighing
from core.condition.changes.evidence import Learnt, along, learnt_without, of_size, signature
from core.condition.changes.hypotheses import LEVEL, Hypotheses, Hypothesis
from core.condition.changes.mixture import interval_of
from core.condition.changes.naming import SIZES
from core.condition.filter.levels import level_now, levels_since
from core.condition.filter.state import RECENT, Candidate, FilterState, Recent
from core.condition.measuring.signatures import PATHS
from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled

APART: Final = 2.0
"""Standard deviations by which the level of another winding has to be higher to be told instead."""
DRIFT_SHAPE: Final = 0.12
"""Relative standard deviation of the level of a change that drifts: no growth is a straight line, and what
the filter takes up of it before the alarm depends on its course."""
OF_A_PATH: Final = 10
"""Numbers that `_weigh_windings` finds of a path."""

Indices = NDArray[np.int64]


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
    shown : complex
        What it adds to y.
    reference : list of float
        State of the filter before the change.
    """

    value: float
    deviation: float
    interval: tuple[float, float]
    winding: int
    path_ratio: float
    onset_ns: int
    levels: tuple[tuple[int, float], ...]
    shown: complex
    reference: list[float]


def turns_level(
    filters: Any, bank: Any, recent: Any, hypotheses: Hypotheses, weighing: Weighing, *, final: bool
) -> TurnsLevel:
    """Return the change of the fault level, should the change be shorted turns.

    Parameters
    ----------
    filters : array of FilterState, shape (1,)
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
    likeliest = int(np.argmax(np.logaddexp.reduce(logs, axis=1)))
    paths: Indices = np.argmax(logs, axis=1)
    at = likeliest * len(PATHS) + int(paths[likeliest])
    candidate, drifting, size = weighing.best[at, :3].tolist()
    onset, drifts = int(candidate), bool(drifting)
    windings = np.arange(3) if final else np.array([likeliest])
    known, jump = _known_without(filters, bank, hypotheses, onset, drifts, at, size)
    # What the filter has taken up of the change comes off its state.
    column = 6 if drifts else 0
    reference = filters["x"][0] - bank["f"][onset, :, column : column + 2] @ jump
    table, levels = np.empty((3, len(PATHS), OF_A_PATH)), np.empty((3, RECENT))
    first, taken = _weigh_windings(
        filters, bank, recent, hypotheses, reference, onset, drifts, known, windings, paths, table, levels
    )
    shape = DRIFT_SHAPE if drifts else 0.0
    found = _level_in(likeliest, table, known[2], shape)
    if final:
        others = (_level_in(w, table, known[2], shape) for w in range(3) if w != likeliest)
        other = max(others, key=lambda level: level.value)
        apart = other.value - found.value
        if apart > APART * hypot(other.deviation, found.deviation):
            found = other
    times = recent["time_ns"][first : first + taken].tolist()
    u_real, u_imaginary = table[found.winding, paths[found.winding], 8:].tolist()
    return TurnsLevel(
        value=found.value,
        deviation=found.deviation,
        interval=interval_of(found.shares, found.values, np.sqrt(found.spreads)),
        winding=found.winding,
        path_ratio=PATHS[int(paths[found.winding])],
        onset_ns=int(bank["time_ns"][onset]),
        levels=tuple(zip(times, levels[found.winding, :taken].tolist(), strict=True)),
        shown=found.value * complex(u_real, u_imaginary),
        reference=reference.tolist(),
    )


@dataclass(frozen=True, slots=True)
class _WindingLevel:
    """The level if the change is in one winding.

    shares, values, spreads: weight, level and variance of each path.
    """

    winding: int
    value: float
    deviation: float
    shares: Array
    values: Array
    spreads: Array


def _level_in(winding: int, table: Array, direction_of_Z2: float, shape: float) -> _WindingLevel:
    """Return the change of the fault level if it is in one winding, from what `_weigh_windings` found."""
    found = table[winding]
    spreads = []
    for value, wandering, a, b, c, direction, relative, _ in found[:, :8].tolist():
        information = a - b * b / (c + 1.0 / max((direction * value) ** 2, 1e-12))
        scale = relative**2 + direction_of_Z2**2 + shape**2
        spreads.append(wandering + 1.0 / max(information, 1e-9) + scale * value**2)
    values, variances = found[:, 0].copy(), np.array(spreads)
    shares = np.exp(found[:, 7].copy())
    shares /= shares.sum()
    mean = float(shares @ values)
    variance = float(shares @ (variances + (values - mean) ** 2))
    return _WindingLevel(winding, mean, sqrt(variance), shares, values, variances)


@compiled
def _known_without(
    filters: list[FilterState], bank: list[Candidate], hypotheses: list[Hypothesis],
    onset: int, drifts: bool, at: int, size: float,
) -> tuple[Learnt, Array]:  # fmt: skip
    """Return what is learnt without the change, and the jump that the change makes in y."""
    known = learnt_without(filters[0], bank[onset], drifts)
    u, _ = signature(known, hypotheses[at])
    return known, size * np.array([u.real, u.imag])


@compiled
def _weigh_windings(
    filters: list[FilterState], bank: list[Candidate], recent: list[Recent], hypotheses: list[Hypothesis],
    reference: Array, onset: int, drifts: bool, known: Learnt, windings: Indices, likeliest: Indices,
    table: Array, levels: Array,
) -> tuple[int, int]:  # fmt: skip
    """Find what each path makes of a change in each of some windings.

    Fills `table` by winding and path with the level, what wandering adds to its variance, the information
    on it as a step (a, b, c), the deviation of its direction and, relatively, of its size, the log of the
    path's weight over the winding's greatest, and what it shows in y; and `levels` with those of each record
    by the winding's likeliest path. Returns the place of the first of these records, and their number.
    """
    state, one = filters[0], bank[onset]
    found, out = np.zeros((RECENT, 3)), np.zeros(5)
    first = taken = 0
    for w in windings:
        for p in range(len(PATHS)):
            it, row = hypotheses[w * len(PATHS) + p], table[w, p]
            u, direction = signature(known, it)
            first = levels_since(state, recent, reference, u, one.time_ns, found)
            taken = int(state.recent) - first
            row[0], row[1] = level_now(found[:taken])
            if p == likeliest[w]:
                levels[w, :taken] = found[:taken, 0]
            along(one, 0, drifts, u, out)
            row[7] = _evidence(out, direction, it.share, drifts)
            along(one, 0, False, u, out)  # noqa: FBT003
            row[2], row[3], row[4] = out[0], out[1], out[2]
            row[5], row[6], row[8], row[9] = direction, it.scale, u.real, u.imag
        table[w, :, 7] -= np.max(table[w, :, 7])
    return first, taken


@compiled
def _evidence(out: Array, direction: float, share: float, drifts: bool) -> float:
    """Return the log of the posterior weight of a path: how well its direction fits decides."""
    usual = LEVEL * (0.5 if drifts else 1.0)
    usually, _, _ = of_size(
        out[0], out[1], out[2], out[3], out[4], SIZES[0] * usual, direction, one_sided=True
    )
    widely, _, _ = of_size(
        out[0], out[1], out[2], out[3], out[4], SIZES[1] * usual, direction, one_sided=True
    )
    high, low = max(usually, widely), min(usually, widely)
    return high + log1p(exp(low - high)) + log(share)
