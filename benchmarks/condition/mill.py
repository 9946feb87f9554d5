"""Measured recordings of a milling machine in a row, as they are and with turns shorted by calculation.

The data is not the project's: its folder is an argument, and nothing but figures is written.
"""

from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.signal import lfilter

from benchmarks.accuracy.measured_records import (
    CURRENTS,
    MILL,
    MILL_FILES,
    MILL_FOLDER,
    MILL_RATE_HZ,
    VOLTAGES,
    mill_samples,
)
from benchmarks.condition.circuit import Array
from benchmarks.condition.following import Said, follow, outcome
from benchmarks.condition.marks import Mark, at_least, at_most, percent
from benchmarks.condition.operation import FIRST_NS, HOUR_NS
from benchmarks.reporting import spread, table
from core.condition.kinds import Kind, State
from core.condition.measuring.observing import observe
from core.condition.observation import Observation
from core.recordings import Recording

CHANNELS = CURRENTS + VOLTAGES
WINDOWS_S = (0.3, 0.5, 1.0)
LEVELS = (0.003, 0.005, 0.01)
PATHS = (0.0, 1.0, 3.0)
REFERENCES = (20, 60)
"""Windows before the shunt."""
SPACINGS_H = (0.01, 1.0, 24.0)
"""Between windows; the motor was at one temperature within seconds."""


@dataclass(frozen=True, slots=True)
class Shunt:
    """Shorted turns that are added to the currents: equivalent level, phase, path over the turns."""

    level: float
    phase: int
    path_ratio: float


@dataclass(frozen=True, slots=True)
class Task:
    """All recordings of a folder in a row, in windows of a length, with a shunt throughout if any."""

    folder: Path
    window_s: float
    shunt: Shunt | None = None


@dataclass(frozen=True, slots=True)
class Case:
    """Windows without a shunt, then with it: what is said after each, and the first accepted with it."""

    task: Task
    said: list[Said]
    first: int

    @property
    def seen(self) -> int | None:
        """Windows with the shunt until a change was found, where there was none before."""
        return _counted(outcome(self.said, self.first).seen)

    @property
    def called(self) -> int | None:
        """Windows with the shunt until the state was fault."""
        return _counted(outcome(self.said, self.first).called_fault)

    @property
    def right(self) -> bool:
        """Whether the phase in the end is that of the shunt."""
        shunt = self.task.shunt
        return shunt is not None and self.said[-1].condition.phase == "abc"[shunt.phase]


def _counted(delay: int | None) -> int | None:
    return None if delay is None else delay + 1


def shunted(samples: Array, shunt: Shunt) -> Array:
    """Currents with what shorted turns add, by the equations of the split winding in a star.

    (r_f + R) i_f + L di_f/dt = mu v_x with R and L those of mu (1 - 2 mu / 3) of a phase: the loop within
    the phase and the star point, which the circulating current moves. The terminals see mu i_f flow in phase
    x and come back by all three.
    """
    mu = shunt.level * (1.0 + shunt.path_ratio)
    own = mu * (1.0 - 2.0 / 3.0 * mu)
    resistance = MILL.parameters.stator_resistance_ohm * (own + shunt.path_ratio * mu)
    inductance = MILL.parameters.stator_leakage_H * own
    voltage = samples[3 + shunt.phase] - samples[3:].mean(axis=0)
    slope = 2.0 * MILL_RATE_HZ * inductance
    loop = lfilter([mu, mu], [resistance + slope, resistance - slope], voltage)
    share = np.full(3, -1.0 / 3.0)
    share[shunt.phase] = 2.0 / 3.0
    added = samples.copy()
    added[:3] += mu * np.outer(share, loop)
    return added


def observations_of(task: Task) -> list[Observation | None]:
    """One a window, all files in a row and an hour apart; None where the quality gate refuses it."""
    length = round(task.window_s * MILL_RATE_HZ)
    found: list[Observation | None] = []
    for name in MILL_FILES:
        samples, _ = mill_samples(task.folder / MILL_FOLDER / name)
        if task.shunt is not None:
            samples = shunted(samples, task.shunt)
        for begin in range(0, samples.shape[1] - length + 1, length):
            part = samples[:, begin : begin + length]
            time_ns = FIRST_NS + len(found) * HOUR_NS
            found.append(observe(Recording(part, MILL_RATE_HZ, time_ns, CHANNELS, trigger_index=0), MILL))
    return found


def mill(folder: Path, pool: Executor, *, every: bool = True) -> Iterator[str | Mark]:
    """Marks and tables of the recordings as they are, and with a shunt; `every` False: a part of them."""
    windows = WINDOWS_S if every else WINDOWS_S[1:2]
    paths = PATHS if every else PATHS[:1]
    plain_tasks = [Task(folder, window) for window in windows]
    plain = dict(zip(windows, spread(observations_of, plain_tasks, "mill, as it is", pool), strict=True))
    shunts = [Shunt(level, phase, path) for level in LEVELS for path in paths for phase in range(3)]
    tasks = [Task(folder, window, shunt) for window in windows for shunt in shunts]
    found = dict(zip(tasks, spread(observations_of, tasks, "mill, with a shunt", pool), strict=True))
    cases = {
        (window, before, level): [
            Case(task, *_switched(plain[window], found[task], before))
            for task in tasks
            if task.window_s == window and _level(task) == level
        ]
        for window in windows
        for before in REFERENCES
        for level in LEVELS
    }
    mark_of_plain, lines = _as_it_is(plain)
    yield mark_of_plain
    for level in LEVELS:
        of_level = [case for (_, _, one), some in cases.items() if one == level for case in some]
        right = sum(case.seen is not None and case.right for case in of_level)
        yield at_least(f"shunt of {percent(level)}: seen, with the right phase", right, len(of_level), 1.0)
    yield from lines
    yield ""
    yield f"With a shunt in each phase, of paths {', '.join(f'{path:g}' for path in paths)}. Delays are"
    yield "windows; the first with the shunt counts as 1."
    yield ""
    header = [
        "windows", "before", "level", "seen", "by window", "shorted turns named", "`fault`", "by window",
        "seen, phase right", "change in the end",
    ]  # fmt: skip
    rows = [
        [f"{window:g} s", f"{before}", f"{level:.1%}", *_row(some)]
        for (window, before, level), some in cases.items()
    ]
    yield from table(header, rows)


def _as_it_is(plain: dict[float, list[Observation | None]]) -> tuple[Mark, list[str]]:
    rows: list[list[str]] = []
    alarms = 0
    for window, observations in plain.items():
        kept = [one for one in observations if one is not None]
        for spacing_h in SPACINGS_H:
            said = list(follow(MILL, _apart(kept, spacing_h)))
            changed = sum(one.changed for one in said)
            faults = sum(one.condition.state is State.FAULT for one in said)
            unhealthy = sum(one.condition.state is not State.HEALTHY for one in said)
            alarms += changed + faults > 0
            reference = said[-1].condition.reference
            rows.append(
                [
                    f"{window:g} s", f"{spacing_h:g} h", f"{len(said)} of {len(observations)}", f"{changed}",
                    f"{faults}", f"{unhealthy}", f"{max(one.statistic for one in said):.1f}",
                    "-" if reference is None else f"{reference.standing.value:.2%}",
                ]
            )  # fmt: skip
    header = [
        "windows", "apart", "records accepted", "with a change", "`fault`", "not healthy",
        "greatest statistic", "standing level",
    ]  # fmt: skip
    return at_most("recordings as they are, cut in any way: an alarm", alarms, len(rows), 0.0), table(
        header, rows
    )


def _apart(observations: list[Observation], spacing_h: float) -> list[Observation]:
    return [
        replace(one, time_ns=FIRST_NS + round((one.time_ns - FIRST_NS) * spacing_h)) for one in observations
    ]


def _level(task: Task) -> float:
    return 0.0 if task.shunt is None else task.shunt.level


def _switched(
    plain: list[Observation | None], faulty: list[Observation | None], before: int
) -> tuple[list[Said], int]:
    """What is said of windows without the shunt, then with it; number of the first accepted with it."""
    healthy = [one for one in plain[:before] if one is not None]
    later = [one for one in faulty[before:] if one is not None]
    return list(follow(MILL, healthy + later)), len(healthy)


def _row(cases: list[Case]) -> list[str]:
    seen = [case.seen for case in cases if case.seen is not None]
    called = [case.called for case in cases if case.called is not None]
    changes = [one.condition.change for case in cases if (one := case.said[-1]).condition.change is not None]
    named = sum(Kind.SHORTED_TURNS in case.said[-1].kinds for case in cases)
    right = sum(case.seen is not None and case.right for case in cases)
    return [
        f"{len(seen)} of {len(cases)}", _span(seen), f"{named}", f"{len(called)}", _span(called), f"{right}",
        f"{min(changes):.2%} to {max(changes):.2%}" if changes else "-",
    ]  # fmt: skip


def _span(delays: list[int]) -> str:
    return f"{min(delays)} to {max(delays)}" if delays else "-"
