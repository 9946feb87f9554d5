"""Measure how motors are judged over time and write docs/evidence/condition.md.

python -m benchmarks.condition [SUBJECT]... [--quick] [--share S] [--data FOLDER] [--page FILE]

Every subject writes its own section with the command that repeats it; sections of subjects that are not
measured stay. With --quick the sections are printed, and written only where a page is given. All random
numbers come from fixed seeds.
"""

import argparse
import os
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from dataclasses import dataclass, replace
from multiprocessing import get_context
from pathlib import Path
from time import perf_counter

from benchmarks.condition.bus import bus
from benchmarks.condition.cost import cost
from benchmarks.condition.detection import detection
from benchmarks.condition.disturbances import disturbances
from benchmarks.condition.end_to_end import AFTER, BEFORE, CYCLES, SPACING_H, end_to_end
from benchmarks.condition.false_alarms import false_alarms
from benchmarks.condition.folding import folding
from benchmarks.condition.forecasts import forecasts
from benchmarks.condition.mill import mill
from benchmarks.condition.second_changes import second_changes
from benchmarks.reporting import Section, write_sections

PAGE = Path(__file__).parents[2] / "docs" / "evidence" / "condition.md"

PREAMBLE = """\
# How well a motor is judged over time

This page is written by `python -m benchmarks.condition`; each section names the command that repeats it.
Every figure is given as it was found, also where it falls short of what is expected.

**Records** of the sections from false alarms to forecasts are phasors, from the machine's own equations and
not from the filter's: three windings in phase variables with shorted turns, a path's resistance and joints,
solved with the star point or the delta (`benchmarks/condition/circuit.py`). The tests hold them against the
core's models and against circuits in phase variables. Each motor has a rating of its own, 0.8 to 400 kW, star
or delta, either sequence, 50 or 60 Hz; a file that is off by up to 10 % in each figure unless said otherwise;
windings that differ by themselves; a cage with skin effect; inductance that saturates; windings that warm
with the load; channels with gains and delays uniform in their class (four classes from 1 % and 50 us to
0.2 % and 10 us), which the file states; a load that is constant, steps, wanders, is random or on a duty
cycle; a supply whose V2/V1 wanders and jumps by up to 4 %, and whose voltage and frequency wander.

**Noise** is that of a channel's phasor from record to record over V1 (currents: over V1/|Z2|): `real` 0.02 %,
as measured motors repeat, and `harsh` 0.2 %.

**Levels** are equivalent ones, turns / (1 + path); `path` is the path's resistance over that of the turns.

**Rates** are given with their 95 % intervals after Clopper and Pearson.
"""


@dataclass(frozen=True, slots=True)
class Effort:
    """How much is measured.

    Healthy motors of a population and their records; motors a cell of steps, a kind of disturbance and a kind
    of growth; buses a case; motors whose cost is measured, their records and those of ten years; motors of
    each kind and case whose records go through files, with the records before and after the case; whether
    every window and path of the mill is measured.
    """

    healthy_motors: int
    healthy_records: int
    steps: int
    disturbed: int
    growing: int
    buses: int
    cost_motors: int
    cost_records: int
    long_records: int
    file_motors: int
    file_records: tuple[int, int]
    whole_mill: bool


FULL = Effort(
    healthy_motors=100, healthy_records=2_400, steps=200, disturbed=200, growing=120, buses=100,
    cost_motors=20, cost_records=2_000, long_records=87_660, file_motors=3, file_records=(BEFORE, AFTER),
    whole_mill=True,
)  # fmt: skip
QUICK = Effort(
    healthy_motors=4, healthy_records=300, steps=3, disturbed=4, growing=3, buses=2,
    cost_motors=2, cost_records=300, long_records=2_000, file_motors=1, file_records=(20, 20),
    whole_mill=False,
)  # fmt: skip


def scaled(effort: Effort, share: float) -> Effort:
    """The same with a share of the motors and buses."""
    names = ("healthy_motors", "steps", "disturbed", "growing", "buses", "cost_motors", "file_motors")
    return replace(effort, **{name: max(1, round(share * getattr(effort, name))) for name in names})


@dataclass(frozen=True, slots=True)
class Subject:
    """A section of the page: its title and what yields its lines."""

    title: str
    lines: Callable[[Effort, Executor], Iterator[str]]


def _false_alarms(effort: Effort, pool: Executor) -> Iterator[str]:
    yield f"Healthy motors, {effort.healthy_motors} a row, hourly unless said otherwise. A motor-day is a day"
    yield "with records after the reference is complete; it counts as `watch` if any of its records leaves"
    yield "the motor other than healthy. `In watch at the end`: without a change, for a standing asymmetry or"
    yield "for a last record that needs confirmation."
    yield ""
    yield from false_alarms(effort.healthy_motors, effort.healthy_records, pool)


def _detection(effort: Effort, pool: Executor) -> Iterator[str]:
    yield f"{effort.steps} motors a row, each with a step of the fault level; hourly records. The first"
    yield "record with the fault counts as 1. The motor's limit is 0.5 %."
    yield ""
    yield from detection(effort.steps, pool)


def _disturbances(effort: Effort, pool: Executor) -> Iterator[str]:
    yield f"{effort.disturbed} motors a row, a disturbance after 60 to 140 hourly records, 300 records after"
    yield "it. Channels: 0.3 to 2 % either way, drifts within 20 to 200 records. Relays: another one of the"
    yield "class. Rewound: R_s and L_ls within 10 %, other asymmetries. Joints: 0.2 to 2 % of the voltage at"
    yield "rated current, in a line. No bus: each motor is judged alone. `In the end`: what is named last."
    yield ""
    yield from disturbances(effort.disturbed, pool)


def _second_changes(effort: Effort, pool: Executor) -> Iterator[str]:
    yield f"{effort.disturbed} motors a row: a change after 60 to 140 hourly records, another one 100 records"
    yield "later, 100 records after it. Shorted turns after another change: 1.5 %; else 1 %, then 2 %; paths"
    yield "of 0 to 3 times the turns' resistance. Channels: 1 to 2 %; joints as above. The delay counts from"
    yield "the second change; `kept` is the share of later records in which fault and phase stayed."
    yield ""
    yield from second_changes(effort.disturbed, pool)


def _bus(effort: Effort, pool: Executor) -> Iterator[str]:
    yield f"{effort.buses} buses a row, five motors each with relays of any class, hourly records within a"
    yield "minute; real noise. What happens, happens to the first motor after 100 records."
    yield ""
    yield from bus(effort.buses, pool)


def _forecasts(effort: Effort, pool: Executor) -> Iterator[str]:
    yield f"{effort.growing} motors a row, a fault that grows by 0.002 to 0.02 % a record (hourly), at a"
    yield "rate that wanders by a factor of two or more, or exponentially with 25 to 100 records; up to four"
    yield "forecasts of each motor from the change's detection on. The time is that until the true level"
    yield "reaches the limit of the forecast. Published are the 5, 50 and 95 % quantiles, as an interval of"
    yield "80 %. Expected of it: that it holds the time in 80 %."
    yield ""
    yield from forecasts(effort.growing, pool)


def _cost(effort: Effort, pool: Executor) -> Iterator[str]:
    yield "Processor time of one core, with whatever else the machine did at the time."
    yield ""
    yield from cost(effort.cost_motors, effort.cost_records, effort.long_records, pool)


def _folding(effort: Effort, pool: Executor) -> Iterator[str]:
    yield "As the workers of the service do it: observations read from a database of their own, followed,"
    yield "what is said from each record on and the history written back, 500 records a transaction."
    yield "With whatever else the machine did at the time."
    yield ""
    yield from folding(effort.cost_motors, effort.cost_records, pool)


def _files(effort: Effort, pool: Executor) -> Iterator[str]:
    before, after = effort.file_records
    yield "The simulator's windings in phase variables, integrated in time, with load swings, harmonics,"
    yield f"noise of 0.2 % a sample, 16-bit converters, 1.6 to 8 kHz, {CYCLES:g} cycles; written as COMTRADE"
    yield f"files, read back, observed and followed as `mcc follow` does. {effort.file_motors} of each of"
    yield "four motors (0.8 to 250 kW) a row, every figure of their files off by up to 10 %, channels within"
    yield f"0.5 % and 25 us; {before} records {SPACING_H:g} hours apart before the case, {after} after it."
    yield ""
    yield from end_to_end(effort.file_motors, pool, before=before, after=after)


SUBJECTS = {
    "false-alarms": Subject("False alarms", _false_alarms),
    "detection": Subject("Shorted turns found", _detection),
    "disturbances": Subject("What is no fault", _disturbances),
    "second-changes": Subject("A second change", _second_changes),
    "bus": Subject("Five motors on a bus", _bus),
    "forecasts": Subject("Forecasts", _forecasts),
    "cost": Subject("Cost", _cost),
    "folding": Subject("Cost in the service", _folding),
    "files": Subject("Records through files", _files),
}
MILL = "mill"


def _mill_section(folder: Path | None, effort: Effort, pool: Executor, command: str) -> Section:
    lines = [
        "Voltages and currents of a milling machine's motor without a recorded fault, 8 kHz, two recordings",
        "in a row: github.com/wjcotta/induction_motor_model, `Mill Data`. Measured, not simulated. Windows",
        "get times an hour apart unless said otherwise. The shunt is that of the split winding, integrated",
        "on the measured voltages and added to the measured currents.",
        "",
        *(mill(folder, pool, every=effort.whole_mill) if folder else ["Not run: no folder of recordings."]),
    ]
    return Section(MILL, "Measured recordings in a row", command, tuple(lines))


def main() -> None:
    """Measure the chosen subjects and put their sections into the page."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.condition", description=(__doc__ or "").splitlines()[0]
    )
    parser.add_argument(
        "subjects", nargs="*", metavar="SUBJECT", help=f"all of {', '.join(SUBJECTS)}, {MILL}"
    )
    parser.add_argument("--data", type=Path, help="folder that holds mill_vi_8khz, the measured recordings")
    parser.add_argument("--quick", action="store_true", help="few motors: for a first look; printed")
    parser.add_argument("--share", type=float, default=1.0, help="share of the motors, 0 to 1")
    parser.add_argument("--page", type=Path, help=f"the page to write ({PAGE.name}; with --quick none)")
    parser.add_argument("--processes", type=int, default=2)
    chosen = parser.parse_args()
    order = [*SUBJECTS, MILL]
    unknown = sorted(set(chosen.subjects) - set(order))
    if unknown:
        parser.error(f"no subject {', '.join(unknown)}: choose among {', '.join(order)}")
    # Matrices are small here: threads of the linear algebra library would only fight over the cores.
    os.environ["OPENBLAS_NUM_THREADS"] = "1"

    effort = QUICK if chosen.quick else FULL
    page = chosen.page or (None if chosen.quick else PAGE)
    options = " --quick" if chosen.quick else ""
    if chosen.share != 1.0:
        effort, options = scaled(effort, chosen.share), f"{options} --share {chosen.share:g}"
    with ProcessPoolExecutor(chosen.processes, mp_context=get_context("spawn")) as pool:
        for name in chosen.subjects or order:
            begun = perf_counter()
            command = f"python -m benchmarks.condition {name}{options}"
            if name == MILL:
                section = _mill_section(chosen.data, effort, pool, f"{command} --data FOLDER")
            else:
                subject = SUBJECTS[name]
                section = Section(name, subject.title, command, tuple(subject.lines(effort, pool)))
            print(f"{name}: {perf_counter() - begun:.0f} s", file=sys.stderr)
            if page is None or (name == MILL and chosen.data is None):
                print(section.text(), flush=True)  # what was not run leaves the page as it is
            else:
                write_sections(page, PREAMBLE, order, [section])


if __name__ == "__main__":
    main()
