"""Measure how often turns shorted in one coil are named, and what is taken for them.

python -m benchmarks.condition.coil_axes [--motors N] [--first N] [--after N]

Motors of 0.8, 7.5 and 160 kW are followed over 24 records and some after a step. The tables are printed.
"""

import argparse
from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np

from benchmarks.condition.coil_records import MOTORS, Kind, Setting, records_of
from benchmarks.processes import worker_processes
from benchmarks.reporting import spread, table
from core.condition.assessment import Change
from core.condition.following.follower import Follower
from core.condition.kinds import Kind as Told

BEFORE = 24
LEVELS = (0.005, 0.01, 0.02)
SIZES = {
    Kind.JOINT: (0.005, 0.05),
    Kind.VOLTAGE: (0.01, 0.05),
    Kind.CURRENT: (0.01, 0.05),
    Kind.ASYMMETRY: (0.01, 0.04),
}
SETTINGS = (
    Setting("loads 0.3-1, I1 and V0"),
    Setting("same, winding given", winding_known=True),
    Setting("no V0", zero_voltage=False),
    Setting("load +-5 %", swing=0.05),
    Setting("X_m scatters 3 %", inductance=0.03),
    Setting("noise 0.2 %", noise=2e-3),
    Setting("all inside one coil", inside_one_coil=True),
    Setting("shorts without a path", most_path=0.0),
    Setting("same, winding given", most_path=0.0, winding_known=True),
    Setting("same, load +-5 %", most_path=0.0, swing=0.05),
    Setting("same, noise 0.2 %", most_path=0.0, noise=2e-3),
)


@dataclass(frozen=True, slots=True)
class Task:
    """One motor, by its number. size: of what happens to it."""

    setting: Setting
    motor: int
    number: int
    kind: Kind
    size: float
    after: int


@dataclass(frozen=True, slots=True)
class Result:
    """What was said in the end.

    named: kinds.  is_turns: shorted turns with a probability of at least 0.98.  phase: whether the one that
    was named is right; None where none was.  level: over the true one.  held: whether the interval holds the
    true level.  axis_error_deg: of the axis that was told; None where none was.
    """

    named: tuple[Told, ...]
    is_turns: bool
    phase: bool | None
    level: float
    held: bool
    axis_error_deg: float | None


def follow_step(task: Task) -> Result:
    """Follow one motor."""
    seed = [task.number, round(1e4 * task.size), list(Kind).index(task.kind), task.motor]
    truth = records_of(task.setting, MOTORS[task.motor], task.kind, task.size, seed, BEFORE, task.after)
    follower = Follower(truth.motor)
    for record in truth.records:
        follower.fold(record)
    assessment = follower.assessment()
    change = None if assessment is None else assessment.change
    if change is None:
        return Result((), is_turns=False, phase=None, level=0.0, held=False, axis_error_deg=None)
    return _of(change, truth.winding, truth.size, truth.axis_deg)


def _of(change: Change, winding: int, size: float, axis_deg: float) -> Result:
    low, high = change.level.ci95
    phase, axis = change.level.phase, change.level.axis_deg
    return Result(
        named=change.named,
        is_turns=change.probabilities[Told.SHORTED_TURNS] >= 0.98,
        phase=None if phase is None else "abc".index(phase) == winding,
        level=change.level.value / size if size else 0.0,
        held=low <= size <= high,
        axis_error_deg=None if axis is None else abs(axis - axis_deg),
    )


def measured(first: int, motors: int, after: int, pool: Executor) -> Iterator[str]:
    """Yield the lines of the tables, of motors from number `first` on."""
    turns, others = [], []
    called: list[Result] = []
    for setting in SETTINGS:
        cells = []
        for level in LEVELS:
            found = _cell(setting, Kind.TURNS, first, [level] * motors, after, pool)
            named = [one for one in found if Told.SHORTED_TURNS in one.named]
            called += named
            cells.append(f"{len(named) / len(found):.2f} ({np.mean([one.is_turns for one in found]):.2f})")
        turns.append([setting.name, *cells])
        row = []
        for kind in (Kind.HEALTHY, *SIZES):
            low, high = SIZES.get(kind, (0.0, 0.0))
            sizes = np.linspace(low, high, motors).tolist()
            found = _cell(setting, kind, first, sizes, after, pool)
            alone = sum(one.named == (Told.SHORTED_TURNS,) for one in found)
            row.append(f"{alone} of {len(found)}")
        others.append([setting.name, *row])
    yield from table(["setting", *(f"{100 * level:g} %" for level in LEVELS)], turns)
    yield ""
    yield from table(["setting", "healthy", *(kind.value for kind in SIZES)], others)
    yield ""
    phases = [one.phase for one in called if one.phase is not None]
    levels = np.array([one.level for one in called])
    axes = [one.axis_error_deg for one in called if one.axis_error_deg is not None]
    yield f"Of {len(called)} named, the phase was told in {len(phases)} and right in {sum(phases)}."
    yield f"Level over the true one: median {np.median(levels):.2f}, standard deviation {levels.std():.2f};"
    yield f"the 95 % interval held it in {np.mean([one.held for one in called]):.1%}."
    yield f"An axis was told in {len(axes)}, the true one in {sum(error < 0.1 for error in axes)}."


def _cell(
    setting: Setting, kind: Kind, first: int, sizes: list[float], after: int, pool: Executor
) -> list[Result]:
    tasks = [
        Task(setting, motor, number, kind, size, after)
        for motor in range(len(MOTORS))
        for number, size in enumerate(sizes, first)
    ]
    return list(spread(follow_step, tasks, f"{setting.name}, {kind.value}", pool))


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--motors", type=int, default=40, help="of each rating in a cell")
    parser.add_argument("--first", type=int, default=1000, help="number of the first motor, its seed")
    parser.add_argument("--after", type=int, default=8, help="records after the step")
    parser.add_argument("--processes", type=int, default=2)
    chosen = parser.parse_args()
    with worker_processes(chosen.processes) as pool:
        for line in measured(chosen.first, chosen.motors, chosen.after, pool):
            print(line, flush=True)


if __name__ == "__main__":
    main()
