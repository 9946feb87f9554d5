"""How large a change is if it is shorted turns: in which winding, averaged over axis and leakage."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot, sqrt
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from core.condition.changes.alarm import Weighing
from core.condition.changes.evidence import Learnt, along, learnt_without, of_size, signature
from core.condition.changes.hypotheses import Cause, Hypotheses, Hypothesis
from core.condition.changes.mixture import interval_of
from core.condition.changes.naming import along_turns, log_share
from core.condition.filter.change_bank import RAMP_LENGTH
from core.condition.filter.levels import level_now, levels_since, without_odd
from core.condition.filter.state import RECENT, Candidate, ComplexArray, FilterState
from core.condition.measuring.turns_grid import TurnsGrid
from core.diagnosis.channel_errors import A
from core.diagnosis.priors import MISFIT
from core.machines.base import Array
from core.machines.compiled import compiled_as_written as compiled

APART: Final = 2.0
"""Standard deviations by which the level of another winding has to be higher to be told instead."""
DRIFT_SHAPE: Final = 0.12
"""Relative standard deviation of the level of a change that drifts: no growth is a straight line, and what
the filter takes up of it before the alarm depends on its course."""
POSSIBLE: Final = 0.02
"""Probability of a winding from which on its level counts in the interval."""
WIDE: Final = 2.0
"""Standard deviation of a level before over what y alone says of it."""
NEGLIGIBLE: Final = 12.0
"""Nodes with so much less evidence than the best are left out."""


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
    windings : tuple of float
        Probability of each winding.
    axes_rad, axis_shares : ndarray
        Axes of the coils in that frame [rad], and the probability of each in that winding.
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
    windings: tuple[float, float, float]
    axes_rad: Array
    axis_shares: Array
    onset_ns: int
    levels: tuple[tuple[int, float], ...]
    shown: complex
    reference: list[float]


def turns_level(
    filters: Any, bank: Any, recent: Any, hypotheses: Hypotheses, grid: TurnsGrid, weighing: Weighing, *,
    final: bool, before: Sequence[float] | None,
) -> TurnsLevel:  # fmt: skip
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
    grid : TurnsGrid
        Axes and leakages, near to one another.
    weighing : Weighing
        Weights after the latest record.
    final : bool
        Whether the change is named for good. What another winding shows then is a second change.
    before : sequence of float or None
        State of the filter before the change, as it was found when that was named; None before that. What
        goes on changing would be taken for it later.

    Returns
    -------
    TurnsLevel
        The level, averaged over axis and leakage.
    """
    first_of_turns = int(np.argmax(hypotheses["cause"] == Cause.SHORTED_TURNS))
    logs = weighing.logs[first_of_turns : len(hypotheses)].reshape(3, -1)
    of_windings = np.logaddexp.reduce(logs, axis=1)
    probabilities = np.exp(of_windings - of_windings.max())
    probabilities /= probabilities.sum()
    likeliest = int(np.argmax(of_windings))
    at = first_of_turns + likeliest * logs.shape[1] + int(np.argmax(logs[likeliest]))
    candidate, drifting, size = weighing.best[at, :3].tolist()
    onset, drifts = int(candidate), bool(drifting)
    known, jump = _known_without(filters, bank, hypotheses, onset, drifts, at, size)
    # What the filter has taken up of the change comes off its state.
    column = 6 if drifts else 0
    reference = filters["x"][0] - bank["f"][onset, :, column : column + 2] @ jump
    if before is not None:
        reference = np.array(before)
    shape = hypot(DRIFT_SHAPE if drifts else 0.0, MISFIT, known[2])
    found = {
        w: _level_in(
            w,
            filters,
            bank,
            recent,
            grid,
            reference,
            onset,
            drifts,
            known,
            shape,
            is_second=probabilities[w] <= POSSIBLE,
        )
        for w in range(3)
        if final or w == likeliest or probabilities[w] > POSSIBLE
    }
    told = found[likeliest]
    if final:
        other = max((found[w] for w in range(3) if w != likeliest), key=lambda level: level.value)
        if other.value - told.value > APART * hypot(other.deviation, told.deviation):
            told = other
            probabilities = np.eye(3)[told.winding]
    counted = [one for one in found.values() if probabilities[one.winding] > POSSIBLE]
    interval = interval_of(
        np.concatenate([probabilities[one.winding] * one.shares for one in counted]),
        np.concatenate([one.values for one in counted]),
        np.sqrt(np.concatenate([one.spreads for one in counted])),
    )
    a, b, c = probabilities.tolist()
    axes, inverse = np.unique(grid.axis_rad[told.nodes], return_inverse=True)
    return TurnsLevel(
        value=told.value,
        deviation=told.deviation,
        interval=(min(interval[0], told.value), max(interval[1], told.value)),
        winding=told.winding,
        windings=(a, b, c),
        axes_rad=axes,
        axis_shares=np.bincount(inverse, told.shares).astype(np.float64),
        onset_ns=int(bank["time_ns"][onset]),
        levels=told.levels,
        shown=told.value * told.shown,
        reference=reference.tolist(),
    )


@dataclass(frozen=True, slots=True)
class _WindingLevel:
    """The level if the change is in one winding.

    nodes: those that count.  shares, values, spreads: weight, level and variance of each.  levels: of the
    records.  shown: what the likeliest adds to y, per level.
    """

    winding: int
    value: float
    deviation: float
    nodes: NDArray[np.int64]
    shares: Array
    values: Array
    spreads: Array
    levels: tuple[tuple[int, float], ...]
    shown: complex


def _level_in(
    winding: int, filters: Any, bank: Any, recent: Any, grid: TurnsGrid, reference: Array, onset: int,
    drifts: bool, known: Learnt, shape: float, *, is_second: bool,
) -> _WindingLevel:  # fmt: skip
    """Return the change of the fault level if it is in one winding."""
    u = A**winding * known[0] * grid.y
    logs, sizes, deviations = _weigh_nodes(
        filters, bank, onset, drifts, known[2], u, grid.current, grid.direction, grid.shares
    )
    if is_second:
        # The weights are those of the first change: of another winding nothing but the usual is known.
        logs = np.log(grid.usual + 1e-300)
        sizes = sizes[np.argmax(logs)] * np.abs(u[np.argmax(logs)] / u)
    best = int(np.argmax(logs))
    nodes = np.flatnonzero(logs > logs[best] - NEGLIGIBLE)
    shares = np.exp(logs[nodes] - logs[best])
    shares /= shares.sum()
    levels, found = np.zeros((RECENT, 3)), complex(u[best])
    first = _levels_since(filters, recent, reference, found, int(bank["time_ns"][onset]), levels)
    taken = int(filters["recent"][0]) - first
    without_odd(levels[:taken])
    now, wandering = level_now(levels[:taken])
    # The level now is that of one node. The others are to it as their sizes are.
    ratio = now / sizes[best] if sizes[best] > 0.0 and now > 0.0 else 0.0
    values = ratio * sizes[nodes] if ratio > 0.0 else np.full(nodes.size, now)
    relative = grid.scale[nodes] ** 2 + shape**2
    spreads = wandering + (ratio * deviations[nodes]) ** 2 + relative * values**2
    spreads = np.maximum(spreads, 1e-12)
    mean = float(shares @ values)
    variance = float(shares @ (spreads + (values - mean) ** 2))
    times = recent["time_ns"][first : first + taken].tolist()
    scale = mean / now if now > 0.0 else 1.0
    return _WindingLevel(
        winding, mean, sqrt(variance), nodes, shares, values, spreads,
        tuple(zip(times, (scale * levels[:taken, 0]).tolist(), strict=True)), found / max(scale, 1e-6),
    )  # fmt: skip


@compiled
def _levels_since(
    filters: list[FilterState], recent: Any, reference: Array, u: complex, onset_ns: int, out: Array
) -> int:
    return levels_since(filters[0], recent, reference, u, onset_ns, out)


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
def _weigh_nodes(
    filters: list[FilterState], bank: list[Candidate], onset: int, drifts: bool, of_Z2: float,
    y: ComplexArray, current: ComplexArray, directions: Array, level_shares: Array,
) -> tuple[Array, Array, Array]:  # fmt: skip
    """Return of each node of a winding the log of its weight, the size by y, and its standard deviation."""
    one, nodes = bank[onset], y.size
    logs, sizes, deviations = np.empty(nodes), np.empty(nodes), np.empty(nodes)
    out = np.empty(5)
    grown = (filters[0].records - one.onset) / RAMP_LENGTH if drifts else 1.0
    for n in range(nodes):
        along(one, 0, drifts, y[n], out)
        sizes[n] = out[3] / max(out[0], 1e-9)
        usual, misfit = along_turns(one, drifts, current[n], 1.0, out)
        direction = hypot(directions[n], of_Z2) / WIDE
        evidence, size, deviations[n] = of_size(
            out[0], out[1], out[2], out[3], out[4], WIDE * usual, direction, one_sided=True
        )
        logs[n] = evidence + misfit + log_share(grown * size, n, level_shares)
    return logs, sizes, deviations
