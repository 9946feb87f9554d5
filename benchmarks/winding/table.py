"""Equations of two numbers against a circuit for every coil, winding by winding."""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import partial
from math import degrees

import numpy as np

from benchmarks.reporting import Section, spread, table
from benchmarks.winding.cases import LEAST_SHARE_OF_C, PATHS, SHAPES, WINDINGS, Case
from benchmarks.winding.one_slip import Seen, Terminals, Turns
from core.machines.parameters import Motor
from testing.machines.slot_faults import CoilFault, SteadyCoils, sequences_of

PHASE = 1
HEADS = (
    "winding",
    "N",
    "c (10-100 % of a coil)",
    "median",
    "misfit, axis of the winding",
    "best delta less it, deg",
    "misfit, on the phase's axis",
)
LOAD_LEVEL = 0.6
UNBALANCE = 0.01 * np.exp(0.8j)


@dataclass(frozen=True, slots=True)
class Fit:
    """A share of one coil in one motor: how the changes of I1 and I2 are described, whatever the path.

    c: kappa over N mu.  misfits: path by path, with the winding's axis.  axis_off: best delta less the
    winding's [deg].  on_axis: misfits of turns that lie on the phase's axis and leak for themselves.
    """

    share: float
    c: float
    misfits: list[float]
    axis_off: float
    on_axis: list[float]


def windings(pool: Executor, *, quick: bool = False) -> list[Section]:
    """Winding by winding."""
    return [_section("windings", "Winding by winding", WINDINGS, pool, quick=quick)]


def shapes(pool: Executor, *, quick: bool = False) -> list[Section]:
    """The same windings in slots of other shapes, with other shares of the coil ends."""
    return [_section("shapes", "Slots of other shapes", SHAPES, pool, quick=quick)]


def _section(subject: str, title: str, cases: Sequence[Case], pool: Executor, *, quick: bool) -> Section:
    found = spread(partial(fits, quick=quick), cases, subject, pool)
    rows = [_row(case, of_case) for case, of_case in zip(cases, found, strict=True)]
    command = f"python -m benchmarks.winding --subject {subject}"
    return Section(subject, title, command, tuple(table(HEADS, rows)))


def fits(case: Case, *, quick: bool = False) -> list[Fit]:
    """Every fault of a case, in each of its motors."""
    return [one for motor in case.motors(quick=quick) for one in _of_motor(case, motor)]


def _of_motor(case: Case, motor: Motor) -> list[Fit]:
    healthy = SteadyCoils.of(motor, case.winding, shape=case.shape)
    running = healthy.running(LOAD_LEVEL, unbalance=complex(UNBALANCE))
    voltage, before = running.phase_voltage, sequences_of(running.line_current)
    _, V1, V2 = sequences_of(voltage)
    terminals = Terminals.of(motor, running.slip, V1, V2)

    def seen(coil: int, share: float, path_ratio: float) -> Seen:
        faulted = SteadyCoils.of(
            motor, case.winding, CoilFault(PHASE, coil, share, path_ratio), shape=case.shape
        )
        currents, _ = faulted.currents(voltage, running.slip)
        return Seen(path_ratio, (sequences_of(currents) - before)[1:])

    found = []
    for coil, share in case.coils_and_shares():
        (delta, link), N = case.axis_and_link(coil), case.winding.coils_per_phase()
        paths = tuple(seen(coil, share, path_ratio) for path_ratio in PATHS)
        turns = Turns(terminals, PHASE, share / N, link, paths)
        kappa = turns.best_kappa(delta)
        found.append(
            Fit(
                share,
                kappa / share,
                turns.misfits(kappa, delta),
                degrees(turns.best_delta(delta) - delta),
                replace(turns, link=1.0).misfits(1.0, 0.0),
            )
        )
    return found


def _row(case: Case, found: Sequence[Fit]) -> list[str]:
    large = [one for one in found if one.share >= LEAST_SHARE_OF_C]
    return [
        case.name,
        str(case.winding.coils_per_phase()),
        _span([one.c for one in large], "{:.2f}"),
        f"{np.median([one.c for one in large]):.2f}",
        _span([100 * off for one in found for off in one.misfits], "{:.1f}") + " %",
        _span([one.axis_off for one in found], "{:+.1f}"),
        _span([100 * off for one in found for off in one.on_axis], "{:.0f}") + " %",
    ]


def _span(values: Sequence[float], written: str) -> str:
    return " to ".join(written.format(value) for value in (min(values), max(values)))
