"""Measure the diagnosis against independent physics and write docs/evidence/accuracy.md.

python -m benchmarks.accuracy [--quick] [--data FOLDER] [--subject NAME]... [--seeds N] [--records N]

Every subject writes its own section with the command that repeats it; sections of subjects that are not
measured stay. All random numbers come from fixed seeds.
"""

import argparse
import os
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from dataclasses import dataclass, replace
from multiprocessing import get_context
from pathlib import Path

from benchmarks.accuracy import measured_records
from benchmarks.accuracy.alarms import (
    ALARM_HEADER,
    BASELINE_RECORDS,
    FOUND_HEADER,
    STATED,
    Draw,
    alarm_row,
    alarms,
    causes,
    count,
    draws_of,
    found_row,
)
from benchmarks.accuracy.cells import (
    COVERAGE_HEADER,
    SNR_20_DB,
    cells,
    coverage,
    coverage_row,
    measure_trial,
    random_trials,
)
from benchmarks.accuracy.intervals import intervals
from benchmarks.accuracy.resistive_paths import resistive_paths
from benchmarks.accuracy.sensor_classes import sensor_classes
from benchmarks.reporting import Section, spread, table, write_sections
from testing.machines.motors import REFERENCE
from testing.machines.steady_faults import FaultModel

PAGE = Path(__file__).parents[2] / "docs" / "evidence" / "accuracy.md"

RELAY_RECORDS = tuple((rate, cycles) for rate in (800.0, 960.0, 1_600.0, 8_000.0) for cycles in (15.0, 64.0))
WINDOW_RECORDS = tuple((10_000.0, cycles) for cycles in (5.0, 10.0, 25.0, 50.0))

PREAMBLE = """\
# How accurate the diagnosis of one record is

Asked: how near is the level of shorted turns to the truth, do its intervals hold the truth, how often is a
healthy motor called faulty, and which faults are found? `python -m benchmarks.accuracy` writes this page;
each section names the command that repeats it. Long tables are files in `data`.

| | found |
| --- | --- |
| deviation over the least that is possible (Cramér-Rao bound) | 1.01 to 1.04 |
| healthy motors called `fault` | 0 of 2,000 |
| shorted turns of 3 % and more called `fault` | all of 303 |
| phase right, of those called | all of 383 |
| intervals of 95 % that hold the level | 97.9 % of 720 |

**Falls short.** Of faults of 1 to 19 % 77 % are called in one record, where 99 % are wanted: below 2 %
sensors of 1 % and 50 us hide them. With a baseline of three records 98.7 % are. A level of 1 % is too low,
and its phase not named, with noise on the currents only. Turns bridged by a resistance in a motor of large
leakage are found, but their level is off by up to a factor of two and more. With currents only, the right
phase of measured faults is the likeliest in 43 of 45, but sure enough to be named in 32; none is wrong.

**One record or many.** In these sections turns lie on the axis of their phase. Of turns in any coil one
record calls less: with channels of 1 % and no winding data 3 % in 25 % of motors of 0.8 kW, in 78 % of 7.5
kW and in all from 37 kW on ([shorted turns inside one coil](winding.md)). A fault of 1 % needs [records over
time](coil-axes.md), which name 93 %.

**Older code.** The sections are of the diagnosis before it weighed coils, axes and leakage, but for `cells`,
`cells-coil` and `measured`. Those on the bound, scatter, baselines, relays and windows are older than the
weighing of turns bridged by a resistance. Single records of today's diagnosis are in [Shorted
turns inside one coil](winding.md) and [Motors that others model](other-winding-models.md).

**Method.** Records are of the simulator's windings in phase variables, integrated in time
(`ied_sim/motor/windings.py`), and of an additional shorted winding
(`testing/machines/disturbed_records.py`). They share no code with the estimator. The motor is the thesis's
(800 W, 380 V, star) unless said otherwise, with its nameplate's parameters. The bound comes from an
independent phasor model (`benchmarks/accuracy/bound.py`). Rates have intervals of 95 % after Clopper and
Pearson.
"""


@dataclass(frozen=True, slots=True)
class Effort:
    """How much is measured: seeds a cell; records of coverage, healthy, faulty, with one factor alone, and a
    cell of the paths; every n-th window; sparse: only the corners of the cells; records a row of
    intervals, and a class of sensors."""

    seeds: int
    covered: int
    healthy: int
    faulty: int
    alone: int
    paths: int
    every: int
    sparse: bool
    interval: int
    classes: int


FULL = Effort(50, 500, 2_000, 500, 300, 24, 1, sparse=False, interval=100, classes=100)
QUICK = Effort(4, 10, 12, 12, 3, 2, 24, sparse=True, interval=2, classes=6)


@dataclass(frozen=True, slots=True)
class Subject:
    """A section of the page: its title and what yields its lines."""

    title: str
    lines: Callable[[Effort, Executor], Iterator[str]]


def _cells(effort: Effort, pool: Executor) -> Iterator[str]:
    yield f"0.5 s at 10 kHz, 20 dB on the currents, {effort.seeds} seeds a cell. Expected: deviation at most"
    yield "1.3 of the bound, bias at most 0.3, phase right in all. `efficient` and `own bias` are those of"
    yield "an efficient estimator on the same noise, and of ours without what the noise does to it."
    yield ""
    yield from cells(seeds=effort.seeds, voltage_noise=0.0, pool=pool, sparse=effort.sparse)


def _cells_noisy(effort: Effort, pool: Executor) -> Iterator[str]:
    yield f"The same with 20 dB on the voltages too, {effort.seeds} seeds a cell."
    yield ""
    yield from cells(seeds=effort.seeds, voltage_noise=SNR_20_DB, pool=pool, sparse=effort.sparse)


def _cells_in_coil(effort: Effort, pool: Executor) -> Iterator[str]:
    yield "The same records judged as those of any motor: turns in a coil, with any leakage. The bound is"
    yield f"that of the split winding, whose leakage is known. {effort.seeds} seeds a cell. A level of 1 %"
    yield "is some 35 % low, for the current leaves the leakage open; no motor has a coil of 1 % of a"
    yield "phase. Where V2/V1 is 10 %, the error that Z2 is allowed explains a fault of 5 % too."
    yield ""
    yield from cells(seeds=effort.seeds, voltage_noise=0.0, pool=pool, sparse=effort.sparse, in_coil=True)


def _coverage(effort: Effort, pool: Executor) -> Iterator[str]:
    yield f"{effort.covered} records of random conditions each (mu 0 to 19 %, load 0 to 1, V2/V1 0 to 10 % at"
    yield "any angle, any phase), 0.5 s at 10 kHz, 20 dB, perfect sensors and parameters: how often"
    yield "`mu_f_scatter95` holds the truth. Expected: in 92 to 98 %."
    yield ""
    yield from coverage(records=effort.covered, pool=pool)


def _intervals(effort: Effort, pool: Executor) -> Iterator[str]:
    yield f"{effort.interval} records a row of level and load, a tenth of it for other motors, with all that"
    yield "disturbs in the next section; `R`: R_s and R_r within 10 %; `R, L`: the inductances too. `its"
    yield "own scatter alone`: how often `mu_f_scatter95` holds the truth."
    yield ""
    yield from intervals(records=effort.interval, pool=pool)


def _alarms(effort: Effort, pool: Executor) -> Iterator[str]:
    yield "All at once, drawn uniformly: load 0 to 1, V2/V1 0 to 5 %, every channel's gain within 1 % and"
    yield "delay 0 to 50 us, THD to 5 %, 49 to 51 Hz, load torque swinging by 10 %, resistances within 10 %"
    yield "(`all parameters`: inductances too), 0.2 % noise, 16 bits, 0.5 s at 10 kHz. Levels 1 to 19 %,"
    yield "log-uniform. Expected: at most 2 of 2,000 healthy ones called, 99 % of the faulty ones, the"
    yield "phase right in 99.5 % of those."
    yield ""
    yield from alarms(healthy=effort.healthy, faulty=effort.faulty, pool=pool)


def _paths(effort: Effort, pool: Executor) -> Iterator[str]:
    yield "6 to 12 % of the turns, bridged by `path` times their own resistance, V2/V1 0 and 3 %. Right is"
    yield "a level within 10 % or inside its interval, and a load within 5 points or inside its own. Levels"
    yield f"are equivalent ones, turns / (1 + path). {effort.paths} records a cell. Where X_ls/R_s is large"
    yield "the leakage limits the current: phase and `fault` stay certain, the level does not, which its"
    yield "interval shows."
    yield ""
    yield from resistive_paths(records=effort.paths, pool=pool)


def _sensor_classes(effort: Effort, pool: Executor) -> Iterator[str]:
    yield f"{effort.classes} healthy and as many faulty records a class; the motor's file names that class."
    yield "Called `fault`, by the true level:"
    yield ""
    yield from sensor_classes(records=effort.classes, pool=pool)


def _baseline(effort: Effort, pool: Executor) -> Iterator[str]:
    yield f"A baseline learnt from {BASELINE_RECORDS} healthy records of the same motor and sensors, at other"
    yield "loads, voltages and frequencies."
    yield ""
    yield from alarms(
        healthy=effort.healthy, faulty=effort.faulty, pool=pool, healthy_before=BASELINE_RECORDS
    )


def _causes(effort: Effort, pool: Executor) -> Iterator[str]:
    yield f"What makes a healthy motor look faulty: one factor at a time, {effort.alone} records each."
    yield ""
    yield from causes(records=effort.alone, pool=pool)


def _relays(effort: Effort, pool: Executor) -> Iterator[str]:
    yield "Records as relays make them, 15 or 64 cycles. Coverage with 20 dB on the currents; alarms, finds"
    yield "under the disturbances of the section before, harmonics as far as the rate can show them."
    yield ""
    yield from _lengths(effort, pool, RELAY_RECORDS)


def _windows(effort: Effort, pool: Executor) -> Iterator[str]:
    yield "0.1, 0.2, 0.5 and 1 s at 10 kHz, otherwise as before."
    yield ""
    yield from _lengths(effort, pool, WINDOW_RECORDS)


def _lengths(effort: Effort, pool: Executor, kinds: tuple[tuple[float, float], ...]) -> Iterator[str]:
    covered, calm_rows, ill_rows = [], [], []
    for rate, cycles in kinds:
        name = f"{rate:g} Hz, {cycles:g} cycles"
        for model in FaultModel:
            samples = round(cycles / REFERENCE.nameplate.rated_frequency_Hz * rate)
            trials = random_trials(model, effort.covered, samples, rate, 0.0)
            measured = list(spread(measure_trial, trials, f"{name} {model.value}", pool))
            covered.append([name, model.value, *coverage_row(measured)])
        healthy = Draw(REFERENCE, 0, faulty=False, factors=STATED, cycles=cycles, sample_rate_hz=rate)
        calm = count(draws_of(healthy, effort.healthy), f"{name} healthy", pool)
        ill = count(draws_of(replace(healthy, faulty=True), effort.faulty), f"{name} faulty", pool)
        calm_rows.append([name, *alarm_row(calm)])
        ill_rows.append([name, *found_row(ill)])
    yield from table(["record", "model", *COVERAGE_HEADER], covered)
    yield ""
    yield from table(["record", *ALARM_HEADER], calm_rows)
    yield ""
    yield from table(["record", *FOUND_HEADER], ill_rows)


SUBJECTS = {
    "cells": Subject("Against the Cramér-Rao bound, noise on the currents", _cells),
    "cells-noisy-voltages": Subject("Against the Cramér-Rao bound, noise on the voltages too", _cells_noisy),
    "cells-coil": Subject("Against the bound, turns in any coil", _cells_in_coil),
    "coverage": Subject("The scatter", _coverage),
    "intervals": Subject("The 95 % intervals", _intervals),
    "alarms": Subject("False alarms and faults found", _alarms),
    "sensor-classes": Subject("By the class of the sensors", _sensor_classes),
    "baseline": Subject("The same, with a baseline", _baseline),
    "paths": Subject("Turns bridged by a resistance", _paths),
    "causes": Subject("Where false alarms come from", _causes),
    "relays": Subject("Relays' rates and lengths", _relays),
    "windows": Subject("Shorter and longer windows", _windows),
}
MEASURED = "measured"


def _measured_section(folder: Path, effort: Effort, pool: Executor, command: str) -> Section:
    lines = [
        "Voltages and currents of a milling machine's motor without a recorded fault, 8 kHz, encoder on the",
        "shaft: github.com/wjcotta/induction_motor_model, `Mill Data`. Measured, not simulated.",
        "",
        *measured_records.mill(folder, every=effort.every, pool=pool),
        "",
        "Real shorted turns, Baldor CM3542, currents only at 1 kHz: Cardenas-Cornejo et al., Measurement 222",
        "(2023), github.com/ibarram/ITSC. Motor parameters are estimates, so mu_f orders the faults but does",
        "not measure them. Suspect labels left out: "
        + ", ".join(f"{label} repetition {k}" for label, k in sorted(measured_records.ITSC_SUSPECT))
        + ".",
        "",
        *measured_records.itsc(folder, pool=pool),
    ]
    return Section(MEASURED, "Measured records", command, tuple(lines))


def main() -> None:
    """Measure the chosen subjects and put their sections into the page."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.accuracy", description=(__doc__ or "").splitlines()[0]
    )
    parser.add_argument("--quick", action="store_true", help="few seeds: for a first look, under 3 minutes")
    parser.add_argument(
        "--data", type=Path, help="folder of the measured recordings; without it they are left"
    )
    parser.add_argument("--subject", action="append", choices=[*SUBJECTS, MEASURED], help="repeatable; all")
    parser.add_argument("--seeds", type=int, help="seeds a cell")
    parser.add_argument("--records", type=int, help="healthy records; half as many faulty ones")
    parser.add_argument("--page", type=Path, default=PAGE, help="the page to write")
    parser.add_argument("--processes", type=int, default=2)
    chosen = parser.parse_args()
    # Matrices are small here: threads of the linear algebra library would only fight over the cores.
    os.environ["OPENBLAS_NUM_THREADS"] = "1"

    effort = QUICK if chosen.quick else FULL
    options = " --quick" if chosen.quick else ""
    if chosen.seeds:
        effort = replace(effort, seeds=chosen.seeds)
        options += f" --seeds {chosen.seeds}"
    if chosen.records:
        effort = replace(
            effort,
            healthy=chosen.records,
            faulty=max(1, chosen.records // 2),
            covered=min(effort.covered, chosen.records),
            paths=min(effort.paths, chosen.records),
            interval=min(effort.interval, chosen.records),
            classes=min(effort.classes, chosen.records),
        )
        options += f" --records {chosen.records}"
    command = f"python -m benchmarks.accuracy{options} --subject"

    order = [*SUBJECTS, MEASURED]
    with ProcessPoolExecutor(chosen.processes, mp_context=get_context("spawn")) as pool:
        for name in chosen.subject or order:
            if name != MEASURED:
                subject = SUBJECTS[name]
                lines = tuple(subject.lines(effort, pool))
                section = Section(name, subject.title, f"{command} {name}", lines)
            elif chosen.data is not None:
                section = _measured_section(chosen.data, effort, pool, f"{command} {MEASURED} --data FOLDER")
            else:
                continue
            write_sections(chosen.page, PREAMBLE, order, [section])


if __name__ == "__main__":
    main()
