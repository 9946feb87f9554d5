"""What plants do to motors and what measures them over time, as courses of records."""

from dataclasses import dataclass, replace
from enum import StrEnum
from math import sqrt
from typing import Final

import numpy as np

from benchmarks.condition.circuit import Array, Complex
from benchmarks.condition.courses import (
    Course,
    healthy,
    shape,
    with_current_error,
    with_fault,
    with_voltage_error,
)
from benchmarks.condition.population import (
    SimulatedMotor,
    draw_channels,
)

DRIFT: Final = 0.012
DRIFT_RECORDS: Final = 60
BANK: Final = 0.4
"""Of a capacitor bank, over the magnetising kvar of the motor."""
HEATER: Final = 0.06
"""Current of a heater between two lines over the motor's rated one."""
SECOND_MOTOR: Final = (0.3, 1.0)
"""Size of another motor on the same terminals over that of the first."""
PATHS: Final = (0.0, 3.0)
LATER: Final = (10, 60)
"""Records between what a plant does first and what it does next."""


class Reality(StrEnum):
    """What a plant does."""

    VOLTAGE_DRIFT = "voltage transformer drifts by 1.2 % in 60 records"
    CURRENT_DRIFT = "current transformer drifts by 1.2 % in 60 records"
    TRANSFORMERS_EXCHANGED = "voltage transformers of the bus exchanged"
    CAPACITOR_LOST = "capacitor bank of 40 % loses an element"
    HEATER = "two-phase heater of 6 % connected"
    SECOND_MOTOR = "second motor connected"


@dataclass(frozen=True, slots=True)
class Happened:
    """What has happened to a motor over its records.

    first: record from which the plant does it.  shorted: record from which turns are shorted, None where
    none are.  phase: of the shorted turns at the terminals.
    """

    course: Course
    first: int
    shorted: int | None
    phase: str


def happens(
    random: np.random.Generator,
    simulated: SimulatedMotor,
    realities: tuple[Reality, ...],
    level: float,
    first: int,
    shorted: int,
    after: int,
) -> Happened:
    """Let a plant do something from a record on, and turns short from another one on, or none at level 0.

    What it does besides begins up to 60 records later.
    """
    begins = [first + int(random.integers(*LATER)) * (k > 0) for k in range(len(realities))]
    records = max(shorted, *begins) + after
    winding = int(random.integers(3))
    # A channel that drifts is that of the shorted phase.
    terminal = simulated.terminal(winding)
    course = healthy(records)
    if level:
        course = with_fault(course, winding, level * shape(records, shorted), float(random.uniform(*PATHS)))
    for one, begin in zip(realities, begins, strict=True):
        course = _with(random, simulated, course, one, begin, terminal)
    return Happened(course, first, shorted if level else None, "abc"[terminal])


def _with(
    random: np.random.Generator,
    simulated: SimulatedMotor,
    course: Course,
    reality: Reality,
    first: int,
    terminal: int,
) -> Course:
    records = len(course)
    since = shape(records, first)
    either = float(random.choice([-1.0, 1.0]))
    match reality:
        case Reality.VOLTAGE_DRIFT:
            drift = shape(records, first, DRIFT_RECORDS)
            return with_voltage_error(course, terminal, complex(either * DRIFT), drift)
        case Reality.CURRENT_DRIFT:
            drift = shape(records, first, DRIFT_RECORDS)
            return with_current_error(course, terminal, complex(either * DRIFT), drift)
        case Reality.TRANSFORMERS_EXCHANGED:
            other = draw_channels(random, simulated.sensors, simulated.motor.nameplate.rated_frequency_Hz)
            ratio = np.where(since[:, np.newaxis] > 0.0, other.voltage / simulated.channels.voltage, 1.0)
            return replace(course, voltage_ratio=course.voltage_ratio * ratio)
        case Reality.CAPACITOR_LOST:
            lines = np.ones((records, 3))
            lines[:, int(random.integers(3))] -= since
            return with_elements(course, (1j * _element_of_bank(simulated) * lines).astype(np.complex128))
        case Reality.HEATER:
            lines = np.zeros((records, 3))
            lines[:, int(random.integers(3))] = since
            line_V = simulated.motor.nameplate.rated_voltage_V
            return with_elements(course, HEATER * rated_current_A(simulated) / line_V * lines)
        case Reality.SECOND_MOTOR:
            return replace(course, second=(first, _second(random, simulated)))


def rated_current_A(simulated: SimulatedMotor) -> float:
    """Estimated rated current of a line, rms."""
    return simulated.motor.nameplate.rated_voltage_V / sqrt(3.0) / simulated.rated_line_impedance_ohm


def with_elements(course: Course, siemens: Array | Complex) -> Course:
    """Admittances between lines 0-1, 1-2 and 2-0 beside the motor, shape (n, 3) [S]."""
    beside = np.zeros((len(course), 3, 3), np.complex128) if course.beside is None else course.beside.copy()
    for k in range(3):
        across = np.zeros(3)
        across[k], across[(k + 1) % 3] = 1.0, -1.0
        beside += siemens[:, k, np.newaxis, np.newaxis] * np.outer(across, across)
    return replace(course, beside=beside)


def _element_of_bank(simulated: SimulatedMotor) -> float:
    """Susceptance of one of three elements in delta."""
    windings, w = simulated.windings, simulated.motor.nameplate.rated_angular_frequency
    reactance = w * float(windings.magnetising_H[0] + windings.stator_leakage_H[0])
    # Between line and neutral, a delta's windings have three times the admittance.
    return BANK / reactance / 3.0 * (3.0 if simulated.delta else 1.0)


def _second(random: np.random.Generator, simulated: SimulatedMotor) -> SimulatedMotor:
    """Another motor of the same supply."""
    size = float(random.uniform(*SECOND_MOTOR))
    windings = simulated.windings
    scaled = replace(
        windings,
        stator_resistance_ohm=windings.stator_resistance_ohm / size * random.uniform(0.8, 1.25),
        rotor_resistance_ohm=windings.rotor_resistance_ohm / size * random.uniform(0.8, 1.25),
        stator_leakage_H=windings.stator_leakage_H / size * random.uniform(0.8, 1.25),
        rotor_leakage_H=windings.rotor_leakage_H / size * random.uniform(0.8, 1.25),
        magnetising_H=windings.magnetising_H / size * random.uniform(0.9, 1.1),
        own_impedance_ohm=windings.own_impedance_ohm[:, random.permutation(3)] / size,
    )
    plate = replace(simulated.motor.nameplate, rated_power_W=size * simulated.motor.nameplate.rated_power_W)
    return replace(simulated, motor=replace(simulated.motor, nameplate=plate), windings=scaled)
