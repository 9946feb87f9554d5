"""Motors in steady running with disturbances drawn at random, and what examination makes of their records.

The physics is the simulator's: a cage of bars and rings in phase variables. The examination knows the motor
with parameters that are off, each anywhere within ten percent, and relays with errors of their class.
"""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from core.diagnosis.acceptance import accept
from core.diagnosis.stator import diagnose_accepted
from core.diagnosis.verdict import Diagnosis
from core.machines.parameters import Motor, ParameterTolerances
from core.rotor.baseband import baseband_of
from core.rotor.examining import examine_rotor
from core.rotor.finding import RotorFinding
from ied_sim.motor.load import Load, Pulsation
from ied_sim.motor.plant import MotorPlant, Operation, rated_current
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Harmonic, Supply
from testing.machines.disturbed_records import record_of
from testing.machines.motors import LARGE, MEDIUM, REFERENCE

MOTORS = {"small": REFERENCE, "medium": MEDIUM, "large": LARGE}
"""0.8, 7.5 and 37 kW."""
BARS = 28
STEP_RATE_HZ = 10_000.0
SETTLING_S = 2.0
LoadSwing = Literal["none", "at 2sf", "near 2sf", "away"]
LOAD_SWINGS: tuple[LoadSwing, ...] = ("none", "at 2sf", "near 2sf", "away")
DEEPEST_SWING = 0.1
MOST_UNBALANCE, MOST_HARMONIC, MOST_NOISE = 0.02, 0.03, 0.01
LARGEST_INERTIA_FACTOR = 6.0


@dataclass(frozen=True, slots=True)
class Subject:
    """One motor in one operation; `seed` draws its disturbances."""

    motor: str
    load_level: float
    broken_bars: int
    swing: LoadSwing
    seed: int
    duration_s: float = 10.0
    sample_rate_hz: float = 10_000.0


@dataclass(frozen=True, slots=True)
class Result:
    """What the examination says of one record; None where the quality gate refused it."""

    subject: Subject
    finding: RotorFinding | None


def examined(subject: Subject, records: int = 1) -> list[Result]:
    """Records of one operation with noise, relays and wrong parameters of their own, each examined."""
    random = np.random.default_rng(
        [subject.seed, subject.broken_bars, round(100 * subject.load_level), LOAD_SWINGS.index(subject.swing)]
    )
    plant = _plant(subject, random)
    rate = subject.sample_rate_hz
    operation = plant.operation(
        0.0, subject.duration_s, rate, settling_s=SETTLING_S, step_rate_hz=STEP_RATE_HZ
    )
    diagnosed: list[Diagnosis] = []
    return [Result(subject, _finding(plant, operation, rate, random, diagnosed)) for _ in range(records)]


def _plant(subject: Subject, random: np.random.Generator) -> MotorPlant:
    motor = MOTORS[subject.motor]
    nameplate = motor.nameplate
    supply = Supply(
        nameplate.rated_voltage_V * random.uniform(0.96, 1.04),
        nameplate.rated_frequency_Hz + random.uniform(-0.1, 0.1),
        unbalance=random.uniform(0.0, MOST_UNBALANCE),
        unbalance_angle_rad=random.uniform(0.0, 2.0 * np.pi),
        harmonics=tuple(
            Harmonic(order, random.uniform(0.0, MOST_HARMONIC), random.uniform(0.0, 2.0 * np.pi))
            for order in (5, 7, 11)
        ),
    )
    inertia = motor.parameters.inertia_kgm2 * (random.uniform(1.0, LARGEST_INERTIA_FACTOR) - 1.0)
    load = Load(subject.load_level, pulsations=_pulsations(subject, random), inertia_kgm2=inertia)
    sensors = Sensors(10.0 * rated_current(motor), 2.0 * nameplate.rated_voltage_V)
    return MotorPlant(motor, supply, load, sensors, broken_bars=subject.broken_bars / BARS)


def _pulsations(subject: Subject, random: np.random.Generator) -> tuple[Pulsation, ...]:
    depth = random.uniform(0.01, DEEPEST_SWING)
    if subject.swing == "none":
        return ()
    if subject.swing == "at 2sf":
        return (Pulsation(depth, twice_slip=True),)
    if subject.swing == "near 2sf":
        distance_hz = 2.0 * 50.0 * _usual_slip(subject.motor) * subject.load_level
        return (Pulsation(depth, frequency_Hz=distance_hz * random.uniform(0.7, 1.5)),)
    return (Pulsation(depth, frequency_Hz=random.uniform(0.2, 15.0)), Pulsation(depth / 2, per_turn=0.4))


def _usual_slip(motor: str) -> float:
    """About the slip at rated load."""
    return {"small": 0.057, "medium": 0.04, "large": 0.013}[motor]


def _finding(
    plant: MotorPlant,
    operation: Operation,
    rate_hz: float,
    random: np.random.Generator,
    diagnosed: list[Diagnosis],
) -> RotorFinding | None:
    """Examine one record. Of an operation the first is diagnosed: only a delay is taken from that."""
    noisy = replace(
        plant.sensors,
        noise=random.uniform(0.001, MOST_NOISE),
        gain_errors=tuple(random.uniform(-0.01, 0.01, 6)),
        offsets=tuple(random.uniform(-0.005, 0.005, 6)),
    )
    true = np.vstack([operation.currents_A, operation.voltages_V])
    record = record_of(noisy.measure(true, plant.rated_values, random), rate_hz)
    acceptance = accept(record, _wrong(plant.motor, random))
    if acceptance.accepted is None:
        return None
    if not diagnosed:
        diagnosed.append(diagnose_accepted(acceptance))
    return examine_rotor(baseband_of(acceptance.accepted), acceptance.accepted, diagnosed[0])


def _wrong(motor: Motor, random: np.random.Generator) -> Motor:
    """The motor with parameters anywhere within their tolerances, and an inertia within half to twice."""
    factors = {
        name: getattr(motor.parameters, name)
        * (1.0 + random.uniform(-1.0, 1.0) * getattr(motor.tolerances, name))
        for name in ParameterTolerances.names()
    }
    inertia = motor.parameters.inertia_kgm2 * 2.0 ** random.uniform(-1.0, 1.0)
    return replace(motor, parameters=replace(motor.parameters, **factors, inertia_kgm2=inertia))
