"""Records in time through COMTRADE files: the simulator's physics, read back, observed and followed."""

from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.condition.courses import shape
from benchmarks.condition.disturbances import outcome_row
from benchmarks.condition.following import Outcome, follow, outcome, quantile_text
from benchmarks.condition.operation import FIRST_NS, HOUR_NS, draw_operation
from benchmarks.condition.population import draw_channels
from benchmarks.reporting import spread, table
from core.condition.kinds import State
from core.condition.measuring.observing import observe
from core.machines.parameters import Motor
from core.machines.sensors import SensorClass
from core.recordings import Quantity, Recording, comtrade_writer, read
from ied_sim.motor.plant import rated_current
from testing.machines.disturbed_records import (
    FULL_SCALE_CURRENT,
    FULL_SCALE_VOLTAGE,
    Disturbances,
    disturbed_record,
    random_harmonics,
)
from testing.machines.motors import LARGE, MEDIUM, REFERENCE, VERY_LARGE
from testing.machines.steady_faults import Condition

MOTORS = (REFERENCE, MEDIUM, LARGE, VERY_LARGE)
SENSORS = SensorClass(0.005, 0.005, 25e-6, 25e-6)
SAMPLE_RATES_HZ = (1_600.0, 4_000.0, 8_000.0)
CYCLES = 25.0
SAMPLE_NOISE = 0.002
"""White, of rated values, beside 16-bit converters."""
SPACING_H = 6.0
BEFORE, AFTER = 60, 60
ERROR = 0.01


class Case(StrEnum):
    """What happens to a motor half-way."""

    HEALTHY = "healthy"
    DEAD_SHORT = "1 %, dead-shorted"
    PATH_1 = "1 %, path 1"
    PATH_3 = "1 %, path 3"
    VOLTAGE_STEP = "voltage channel, 1 % step"
    VOLTAGE_DRIFT = "voltage channel, 1 % in 40 records"
    CURRENT_STEP = "current channel, 1 % step"


PATHS = {Case.DEAD_SHORT: 0.0, Case.PATH_1: 1.0, Case.PATH_3: 3.0}


@dataclass(frozen=True, slots=True)
class Task:
    """One motor with a case, by its number."""

    motor: Motor
    case: Case
    number: int
    before: int = BEFORE
    after: int = AFTER


@dataclass(frozen=True, slots=True)
class Result:
    """What came of a motor: refused records, others than healthy, and whether the phase is right."""

    outcome: Outcome
    right: bool
    records: int
    refused: int
    unhealthy: int


def follow_files(task: Task) -> Result:
    """Write the records as COMTRADE files, read them back and follow the motor."""
    random = np.random.default_rng([task.number, 7, list(Case).index(task.case), MOTORS.index(task.motor)])
    motor = replace(task.motor, sensors=SENSORS)
    records = task.before + task.after
    winding = int(random.integers(3))
    observations = []
    with TemporaryDirectory() as folder:
        for k, recording in enumerate(_recordings(task, random, winding, records)):
            path = comtrade_writer.write(Path(folder) / f"{k:05d}.cfg", recording)
            observations.append(observe(read(path), motor))
    kept = [one for one in observations if one is not None]
    first = sum(one is not None for one in observations[: task.before])
    said = list(follow(motor, kept))
    found = outcome(said, first)
    return Result(
        outcome=found,
        right=found.phase == "abc"[winding],
        records=records,
        refused=records - len(kept),
        unhealthy=sum(one.condition.state is not State.HEALTHY for one in said),
    )


def _recordings(task: Task, random: np.random.Generator, winding: int, records: int) -> Iterator[Recording]:
    """Every record with its own load, warmth, supply, harmonics and noise; channels that stay as they are."""
    nameplate = task.motor.nameplate
    operation = draw_operation(random, records)
    channels = draw_channels(random, SENSORS, nameplate.rated_frequency_Hz)
    ratios = np.concatenate([channels.current, channels.voltage])
    w = nameplate.rated_angular_frequency
    # The delays of a relay are positive: what all channels have in common is no error.
    delays = -np.angle(ratios) / w + 30e-6
    parameters = random.uniform(0.9, 1.1, 5)
    rate = float(random.choice(SAMPLE_RATES_HZ))
    harmonics = random_harmonics(random, random.uniform(0.0, 0.04), rate)
    reverse = bool(random.uniform() < 0.4)
    since = shape(records, task.before, 40 if task.case is Case.VOLTAGE_DRIFT else 0)
    channel = {Case.VOLTAGE_STEP: 3, Case.VOLTAGE_DRIFT: 3, Case.CURRENT_STEP: 0}.get(task.case)
    place = int(random.integers(3))
    sign = float(random.choice([-1.0, 1.0]))
    for k in range(records):
        gains = np.abs(ratios) - 1.0
        if channel is not None:
            gains[channel + place] += sign * ERROR * since[k]
        path = PATHS.get(task.case)
        level = 0.0 if path is None else 0.01 * (1.0 + path) * since[k]
        warm = operation.warming[k]
        condition = Condition(
            load_level=float(operation.load[k]),
            unbalance=complex(operation.unbalance[k]),
            level=float(level),
            winding=winding,
            path_ratio=path or 0.0,
            reverse=reverse,
        )
        disturbances = Disturbances(
            gain_errors=tuple(gains.tolist()),
            delays_s=tuple(delays.tolist()),
            harmonics=harmonics,
            frequency_hz=float(nameplate.rated_frequency_Hz * operation.frequency_ratio[k]),
            swing=float(random.uniform(0.0, 0.03)),
            swing_frequency_hz=float(random.uniform(0.5, 10.0)),
            parameter_factors=tuple((parameters * np.array([warm, warm, 1.0, 1.0, 1.0])).tolist()),
            noise=SAMPLE_NOISE,
        )
        made = disturbed_record(
            task.motor, condition, disturbances, start_s=float(random.uniform(0.0, 100.0)),
            cycles=CYCLES, sample_rate_hz=rate, seed=1_000_000 * task.number + k,
        )  # fmt: skip
        yield _as_recorded(made, task.motor, FIRST_NS + round(k * SPACING_H * HOUR_NS))


def _as_recorded(made: Recording, motor: Motor, time_ns: int) -> Recording:
    """The record with its time, its relay and the range of its converters."""
    scales = {
        Quantity.CURRENT: FULL_SCALE_CURRENT * rated_current(motor),
        Quantity.PHASE_VOLTAGE: FULL_SCALE_VOLTAGE * motor.nameplate.rated_voltage_V,
    }
    channels = tuple(replace(one, full_scale=scales[one.quantity]) for one in made.channels)
    return Recording(
        made.samples, made.sample_rate_hz, time_ns, channels, trigger_index=0,
        nominal_frequency_hz=motor.nameplate.rated_frequency_Hz, station="plant", device="relay",
    )  # fmt: skip


def end_to_end(each: int, pool: Executor, *, before: int = BEFORE, after: int = AFTER) -> Iterator[str]:
    """A table of the cases over all motors."""
    rows = []
    for case in Case:
        tasks = [Task(motor, case, number, before, after) for motor in MOTORS for number in range(each)]
        found = list(spread(follow_files, tasks, f"files, {case.value}", pool))
        outcomes = [one.outcome for one in found]
        called = [one for one in found if one.outcome.called_fault is not None]
        seen = np.array([one.seen for one in outcomes if one.seen is not None], dtype=np.float64)
        delays = np.array([one.outcome.called_fault for one in called], dtype=np.float64)
        rows.append(
            [
                case.value, f"{len(found)}", f"{sum(one.records for one in found)}",
                f"{sum(one.refused for one in found)}", f"{len(seen)}", quantile_text(seen),
                f"{len(called)}", quantile_text(delays),
                f"{sum(one.right for one in called)} of {len(called)}" if case in PATHS else "-",
                outcome_row(outcomes)[1], f"{sum(one.unhealthy for one in found)}",
            ]
        )  # fmt: skip
    yield from table(
        [
            "case", "motors", "records", "refused", "seen", "by record, median", "called `fault`",
            "by record, median", "phase right", "in the end", "records other than healthy",
        ],
        rows,
    )  # fmt: skip
