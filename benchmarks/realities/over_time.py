"""Measure what becomes of motors whose plant does something to them or to their measurements.

python -m benchmarks.realities.over_time [--motors N] [--json FILE] [--before FILE] [--page FILE]

Motors of 0.8 to 400 kW are followed over hourly records. `--json` keeps the figures; `--before` shows those
of another version beside them.
"""

import argparse
import json
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np

from benchmarks.condition.following import follow
from benchmarks.condition.operation import draw_operation
from benchmarks.condition.population import draw_motor
from benchmarks.condition.records import REAL_NOISE, measure
from benchmarks.processes import worker_processes
from benchmarks.realities.histories import DRIFT_RECORDS, LATER, Reality, happens
from benchmarks.reporting import spread, table, with_tables_as_files
from core.condition.kinds import Kind, State

PAGE: Final = Path("docs/evidence/realities-over-time.md")
BEFORE: Final = (24, 80)
AFTER: Final = 40
SOON: Final = 10
LEVELS: Final = (0.05, 0.02)
DRIFTS: Final = (Reality.VOLTAGE_DRIFT, Reality.CURRENT_DRIFT)
LOADS: Final = (Reality.CAPACITOR_LOST, Reality.HEATER, Reality.SECOND_MOTOR)
AT_ONCE: Final = 1.0 / 3.0
"""Share of pairs drawn at random in which turns short with the first record of the plant's doing."""


@dataclass(frozen=True, slots=True)
class Cell:
    """What is played: what the plant does, turns shorted, and when.

    level: 0 for none.  apart: records between the two; None for some at random, or none.  pairs: whether two
    realities are drawn at random in place of `realities`.
    """

    name: str
    realities: tuple[Reality, ...]
    level: float
    apart: int | None = 0
    pairs: bool = False


@dataclass(frozen=True, slots=True)
class Task:
    """One motor of a cell, by its number."""

    cell: Cell
    number: int


@dataclass(frozen=True, slots=True)
class Result:
    """What was said.

    false: records in which a sound motor was a `fault`.  soon, ever: whether the shorted turns were a `fault`
    within ten records, or 40.  phase: whether the phase that was named at the end is right; None where none
    was.  held: whether the interval of the level holds the true one; None where it was no fault.  last: what
    was named at the end.
    """

    false: int
    soon: bool
    ever: bool
    phase: bool | None
    held: bool | None
    last: str


@dataclass(slots=True)
class Counts:
    """Results of a cell in numbers."""

    motors: int = 0
    false: int = 0
    soon: int = 0
    ever: int = 0
    phases: int = 0
    right: int = 0
    faults: int = 0
    held: int = 0
    last: dict[str, int] = field(default_factory=dict)


def cells() -> list[Cell]:
    """All that is played, in the order of the page."""
    found = []
    for one in Reality:
        apart = DRIFT_RECORDS if one in DRIFTS else 0 if one is Reality.TRANSFORMERS_EXCHANGED else None
        found += [Cell(one.value, (one,), level, apart) for level in (0.0, *LEVELS)]
    found += [Cell("two of these, drawn at random", (), level, None, pairs=True) for level in (0.0, *LEVELS)]
    return found


def follow_history(task: Task) -> Result:
    """Simulate a motor and follow it."""
    cell = task.cell
    random = np.random.default_rng([task.number, 44, round(1e3 * cell.level), *map(ord, cell.name)])
    simulated = draw_motor(random)
    realities, apart = cell.realities, cell.apart
    if cell.pairs:
        drawn = random.choice(len(Reality), 2, replace=False)
        realities = tuple(list(Reality)[k] for k in drawn.tolist())
    if apart is None:
        at_once = cell.pairs and random.uniform() < AT_ONCE
        apart = 0 if at_once else int(random.integers(*LATER))
    first = int(random.integers(*BEFORE))
    shorted = first + apart
    happened = happens(random, simulated, realities, cell.level, first, shorted, AFTER)
    operation = draw_operation(random, len(happened.course))
    records = measure(random, simulated, operation, happened.course, REAL_NOISE).observations()
    said = list(follow(simulated.motor, records, range(first - 1, len(records))))
    faults = [one.record for one in said if one.condition.state is State.FAULT]
    last = said[-1].condition
    is_fault = bool(cell.level) and last.state is State.FAULT
    kinds = last.candidates or (last.kind,)
    level = float(happened.course.level[-1])
    return Result(
        false=sum(not cell.level or record < shorted for record in faults),
        soon=any(shorted <= record < shorted + SOON for record in faults) and bool(cell.level),
        ever=any(record >= shorted for record in faults) and bool(cell.level),
        phase=last.phase == happened.phase if is_fault and last.phase is not None else None,
        held=_holds(last.mu_f_ci95, level) if is_fault else None,
        last=" or ".join(sorted(str(kind) for kind in kinds if kind is not Kind.NONE)) or "none",
    )


def _holds(interval: tuple[float, float] | None, level: float) -> bool:
    return interval is not None and interval[0] <= level <= interval[1]


def counted(results: Sequence[Result]) -> Counts:
    """Results in numbers."""
    found = Counts(motors=len(results))
    for one in results:
        found.false += one.false > 0
        found.soon += one.soon
        found.ever += one.ever
        found.phases += one.phase is not None
        found.right += bool(one.phase)
        found.faults += one.held is not None
        found.held += bool(one.held)
        found.last[one.last] = found.last.get(one.last, 0) + 1
    return found


def measured(motors: int, first: int, pool: Executor) -> dict[str, Counts]:
    """Play every cell with so many motors."""
    found = {}
    for cell in cells():
        tasks = [Task(cell, number) for number in range(first, first + motors)]
        key = f"{cell.name}|{cell.level}"
        found[key] = counted(list(spread(follow_history, tasks, f"{cell.name}, {cell.level:.0%}", pool)))
    return found


def tables(found: Mapping[str, Counts], before: Mapping[str, Mapping[str, Any]]) -> Iterator[str]:
    """Healthy motors, and motors with shorted turns."""
    healthy, shorted = [], []
    for key, now in found.items():
        name, level = key.split("|")
        old = before.get(key)
        if not float(level):
            likely = sorted(now.last.items(), key=lambda one: -one[1])[:3]
            words = ", ".join(f"{kind} {count}" for kind, count in likely)
            healthy.append([name, _old(old, "false"), f"{now.false} of {now.motors}", words])
            continue
        shorted.append(
            [
                name, f"{100.0 * float(level):g} %", _old(old, "soon"), f"{now.soon} of {now.motors}",
                f"{now.ever} of {now.motors}", f"{now.right} of {now.phases}", f"{now.held} of {now.faults}",
                f"{now.false}",
            ]
        )  # fmt: skip
    yield "No turns shorted: motors that were called `fault`, and what was named at the end."
    yield ""
    yield from table(["what the plant does", "before", "now", "named at the end"], healthy)
    yield ""
    yield "Turns shorted: motors that were called `fault` within 10 records of the short, and within 40."
    yield ""
    yield from table(
        [
            "what the plant does", "shorted", "within 10, before", "within 10", "within 40",
            "phase right, of those named", "interval holds the level", "called before the short",
        ],
        shorted,
    )  # fmt: skip


def _old(counts: Mapping[str, Any] | None, what: str) -> str:
    return "-" if counts is None else f"{counts[what]} of {counts['motors']}"


PREAMBLE: Final = """\
# What plants do to motors, over time

Asked: is a motor called faulty because of what hangs beside it or measures it, and is a fault seen beside
that? `python -m benchmarks.realities.over_time --motors {motors} --first {first}` prints these tables:
{motors} motors a row, numbers {first} to {last}, 0.8 to 400 kW, star and delta, parameters off by 10 %,
relays of four classes, hourly records with the scatter of measured motors, 24 to 80 of them healthy.
Currents are phasors of a circuit of its own (`benchmarks/condition/circuit.py`). "Before" is the version
before a second change was followed and other loads were known as a cause. Turns short at the end of a
drift, with the first record after an exchange, or else 10 to 60 records after the plant did something (in
one of three pairs with the same record).
"""


REMARKS: Final = """
**Falls short.** Turns that short after a second motor was connected are found in a
third of the motors: what the two draw together is not on the circle of the one in the file. Turns that
short with the record in which something else changes are told only where they are the larger part. A
capacitor that loses an element often stays between `other-load` and `shorted-turns`, on `watch`: a record
at another load, or the feeder's current at rest, tells which. Sound motors called in pairs are small,
with levels just above the limit. A level of 5 % lies outside its interval more often than one in twenty.
"""


def main() -> None:
    """Measure, print, and write the page."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--motors", type=int, default=100, help="in a cell")
    parser.add_argument("--first", type=int, default=0, help="number of the first motor, its seed")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--json", type=Path, help="file to keep the figures in")
    parser.add_argument("--before", type=Path, help="figures of another version, as --json keeps them")
    parser.add_argument(
        "--figures", type=Path, help="figures to print, as --json keeps them: none are measured"
    )
    parser.add_argument("--page", type=Path, help=f"the page to write ({PAGE})")
    chosen = parser.parse_args()
    if chosen.figures is not None:
        kept = json.loads(chosen.figures.read_text(encoding="utf-8"))
        found = {key: Counts(**counts) for key, counts in kept.items()}
    else:
        with worker_processes(chosen.processes) as pool:
            found = measured(chosen.motors, chosen.first, pool)
    if chosen.json is not None:
        document = {key: asdict(one) for key, one in found.items()}
        chosen.json.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
    before = {} if chosen.before is None else json.loads(chosen.before.read_text(encoding="utf-8"))
    lines = list(tables(found, before))
    print("\n".join(lines))
    if chosen.page is not None:
        text = PREAMBLE.format(
            motors=chosen.motors, first=chosen.first, last=chosen.first + chosen.motors - 1
        )
        kept = with_tables_as_files(chosen.page, chosen.page.stem, lines)
        chosen.page.write_text(text + "\n" + "\n".join(kept) + "\n" + REMARKS, encoding="utf-8")


if __name__ == "__main__":
    main()
