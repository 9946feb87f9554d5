"""Records in time through COMTRADE files: the simulator's physics, written, read back and observed."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

import numpy as np

from benchmarks.condition.circuit import Array
from benchmarks.condition.courses import shape
from benchmarks.condition.operation import FIRST_NS, HOUR_NS, Operation
from benchmarks.condition.population import Channels, draw_channels
from core.condition.measuring.observing import observe
from core.condition.observation import Observation
from core.machines.parameters import Motor
from core.machines.sensors import SensorClass
from core.recordings import Quantity, Recording, comtrade, read
from ied_sim.motor.plant import rated_current
from testing.machines.disturbed_records import (
    FULL_SCALE_CURRENT,
    FULL_SCALE_VOLTAGE,
    Disturbances,
    disturbed_record,
    random_harmonics,
)
from testing.machines.steady_faults import Condition

SENSORS: Final = SensorClass(0.005, 0.005, 25e-6, 25e-6)
LEAST_DELAY_S: Final = 30e-6
"""The delays of a relay are positive: what all channels have in common is no error."""
SAMPLE_RATES_HZ: Final = (1_600.0, 4_000.0, 8_000.0)
STEP_RATE_HZ: Final = 5_000.0
"""Of the integration. Phasors are within 2e-6 of those with 20 kHz, a tenth of the noise of a record."""
CYCLES: Final = 25.0
SAMPLE_NOISE: Final = 0.002
"""White, of rated values, beside 16-bit converters."""
SPACING_H: Final = 6.0
LEVEL = ERROR = 0.01
DRIFT_RECORDS: Final = 40
SUPPLY_STEPS: Final = (0.01, 0.04)


class Case(StrEnum):
    """What happens to a motor, to what measures it or to its supply."""

    HEALTHY = "healthy"
    DEAD_SHORT = "1 %, dead-shorted"
    PATH_1 = "1 %, path 1"
    PATH_3 = "1 %, path 3"
    VOLTAGE_STEP = "voltage channel, 1 % step"
    VOLTAGE_DRIFT = "voltage channel, 1 % in 40 records"
    CURRENT_STEP = "current channel, 1 % step"
    CURRENT_DRIFT = "current channel, 1 % in 40 records"
    RELAY = "relay exchanged, unannounced"
    SUPPLY = "supply, step of V2/V1 by 1 to 4 %"


PATHS: Final = {Case.DEAD_SHORT: 0.0, Case.PATH_1: 1.0, Case.PATH_3: 3.0}
CHANNELS: Final = {
    Case.VOLTAGE_STEP: 3, Case.VOLTAGE_DRIFT: 3, Case.CURRENT_STEP: 0, Case.CURRENT_DRIFT: 0,
}  # fmt: skip
"""Of a case with a channel's error, the first of the three it may be."""


@dataclass(frozen=True, slots=True)
class Course:
    """A motor with a case that begins at a record (from 0), the supply it has, and what numbers its noise.

    winding: that of the shorted turns.  reverse: whether the supply turns a-c-b.
    """

    motor: Motor
    case: Case
    first: int
    winding: int
    operation: Operation
    reverse: bool
    seed: int


def through_files(course: Course, random: np.random.Generator) -> list[Observation | None]:
    """Write the records as COMTRADE files, read them back and observe them; None where one is refused."""
    observations = []
    with TemporaryDirectory() as folder:
        for k, recording in enumerate(_recordings(course, random)):
            path = comtrade.write(Path(folder) / f"{k:05d}.cfg", recording)
            observations.append(observe(read(path), course.motor))
    return observations


def with_supply_step(random: np.random.Generator, operation: Operation, first: int) -> Operation:
    """The same with another V2/V1 from a record on."""
    size = complex(random.uniform(*SUPPLY_STEPS) * np.exp(2j * np.pi * random.uniform()))
    return replace(operation, unbalance=operation.unbalance + size * shape(len(operation), first))


def _recordings(course: Course, random: np.random.Generator) -> Iterator[Recording]:
    """Every record with its own load, warmth, supply, harmonics and noise."""
    motor, operation = course.motor, course.operation
    frequency = motor.nameplate.rated_frequency_Hz
    relays = [draw_channels(random, SENSORS, frequency) for _ in range(2)]
    parameters = random.uniform(0.9, 1.1, 5)
    rate = float(random.choice(SAMPLE_RATES_HZ))
    harmonics = random_harmonics(random, random.uniform(0.0, 0.04), rate)
    drifts = course.case in (Case.VOLTAGE_DRIFT, Case.CURRENT_DRIFT)
    since = shape(len(operation), course.first, DRIFT_RECORDS if drifts else 0)
    wrong = np.zeros(6)
    if course.case in CHANNELS:
        place = CHANNELS[course.case] + int(random.integers(3))
        wrong[place] = ERROR * random.choice([-1.0, 1.0])
    path = PATHS.get(course.case)
    for k in range(len(operation)):
        other = course.case is Case.RELAY and k >= course.first
        gains, delays = _errors(relays[other], motor)
        warm = operation.warming[k]
        condition = Condition(
            load_level=float(operation.load[k]),
            unbalance=complex(operation.unbalance[k]),
            level=0.0 if path is None else float(LEVEL * (1.0 + path) * since[k]),
            winding=course.winding,
            path_ratio=path or 0.0,
            reverse=course.reverse,
        )
        disturbances = Disturbances(
            gain_errors=tuple((gains + wrong * since[k]).tolist()),
            delays_s=tuple(delays.tolist()),
            harmonics=harmonics,
            frequency_hz=float(frequency * operation.frequency_ratio[k]),
            swing=float(random.uniform(0.0, 0.03)),
            swing_frequency_hz=float(random.uniform(0.5, 10.0)),
            parameter_factors=tuple((parameters * np.array([warm, warm, 1.0, 1.0, 1.0])).tolist()),
            noise=SAMPLE_NOISE,
        )
        made = disturbed_record(
            motor, condition, disturbances, start_s=float(random.uniform(0.0, 100.0)), cycles=CYCLES,
            sample_rate_hz=rate, seed=1_000_000 * course.seed + k, step_rate_hz=STEP_RATE_HZ,
        )  # fmt: skip
        yield _as_recorded(made, motor, FIRST_NS + round(k * SPACING_H * HOUR_NS))


def _errors(relay: Channels, motor: Motor) -> tuple[Array, Array]:
    """Gain errors and delays [s] of the six channels."""
    ratios = np.concatenate([relay.current, relay.voltage])
    delays = -np.angle(ratios) / motor.nameplate.rated_angular_frequency
    return np.abs(ratios) - 1.0, delays + LEAST_DELAY_S


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
