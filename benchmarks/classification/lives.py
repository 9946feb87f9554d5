"""Motors over their records and starts: a healthy past, then a cause begins."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from math import pi

import numpy as np

from benchmarks.classification.cases import MOTORS, drawn_sizes
from core.diagnosis.causes import NOTHING, Cause, Causes
from core.machines.parameters import Motor
from core.recordings import Recording
from core.units import NANOSECONDS_PER_SECOND
from ied_sim.motor.plant import MotorPlant
from testing.machines.cause_records import (
    SOME_TIME_NS,
    STEP_RATE_HZ,
    CauseCase,
    Sizes,
    Surroundings,
    plant_with,
)
from testing.machines.disturbed_records import CHANNELS

PAST, PRESENT = 40, 20
"""Records of the healthy past, and from when a cause is there."""
STARTS_OF_PAST, STARTS_OF_PRESENT = (0, 8, 16, 24, 32), (45, 50, 55)
"""Numbers of the records before which the motor is started."""
RECORD_S, START_S, AT_REST_S, RATE_HZ = 4.0, 1.5, 0.04, 4_000.0
START_SCALE = 20.0
"""Range of the current channels in a start, over the rated current."""
HOUR_NS = 3_600 * NANOSECONDS_PER_SECOND
USUAL_LOADS, LOAD_SCATTER = (0.5, 0.65), 0.05
LOAD_CHANGES = (0.25, 0.4)
"""By how much a load changes, to either side, over rated torque."""
VOLTAGE_SCATTER, UNBALANCE_SCATTER = 0.008, 0.002
WARMTH = (0.95, 1.15)
"""Resistances from record to record, over those of the motor's parameters."""


@dataclass(frozen=True, slots=True)
class Life:
    """One motor; `seed` draws its errors, its operation and the size of what happens to it.

    All but the cause is the same whatever the cause is, so that motors of one seed share their past.
    """

    motor: str
    seed: int
    surroundings: Surroundings = field(init=False)
    sizes: Sizes = field(init=False)
    usual_load: float = field(init=False)
    load_change: float = field(init=False)

    def __post_init__(self) -> None:
        random = np.random.default_rng([self.seed, 4])
        drawn = {
            "surroundings": Surroundings.drawn(random, MOTORS[self.motor].nameplate),
            "sizes": drawn_sizes(self.seed),
            "usual_load": random.uniform(*USUAL_LOADS),
            "load_change": random.choice([-1.0, 1.0]) * random.uniform(*LOAD_CHANGES),
        }
        for name, value in drawn.items():
            object.__setattr__(self, name, value)

    def known(self) -> Motor:
        """Return the motor as its file knows it, all the time."""
        return CauseCase(MOTORS[self.motor], NOTHING, 1.0, self.seed).known()

    def past(self) -> Iterator[tuple[bool, Recording]]:
        """Yield the records of the healthy past, and whether each is of a start."""
        yield from self._recordings(NOTHING, range(PAST))

    def present(self, causes: Causes) -> Iterator[tuple[bool, Recording]]:
        """Yield those from when the causes are there."""
        yield from self._recordings(causes, range(PAST, PAST + PRESENT))

    def _recordings(self, causes: Causes, numbers: range) -> Iterator[tuple[bool, Recording]]:
        for number in numbers:
            if number in STARTS_OF_PAST + STARTS_OF_PRESENT:
                yield True, self._start(causes, number)
            yield False, self._running(causes, number)

    def _running(self, causes: Causes, number: int) -> Recording:
        random = np.random.default_rng([self.seed, 5, number])
        plant = self._plant(causes, number, random)
        true = plant.operation(0.0, RECORD_S, RATE_HZ, settling_s=plant.settling_s, step_rate_hz=STEP_RATE_HZ)
        samples = plant.sensors.measure(
            np.vstack([true.currents_A, true.voltages_V]), plant.rated_values, random
        )
        return Recording(samples, RATE_HZ, SOME_TIME_NS + number * HOUR_NS, CHANNELS)

    def _start(self, causes: Causes, number: int) -> Recording:
        random = np.random.default_rng([self.seed, 6, number])
        plant = self._plant(causes, number, random)
        true = plant.start_up(random.uniform(0.0, 0.02), START_S, RATE_HZ)
        at_rest = round(AT_REST_S * RATE_HZ)
        samples = np.hstack([np.zeros((6, at_rest)), np.vstack([true.currents_A, true.voltages_V])])
        sensors = replace(plant.sensors, full_scale_A=START_SCALE * float(plant.rated_values[0]))
        return Recording(
            sensors.measure(samples, plant.rated_values, random),
            RATE_HZ,
            SOME_TIME_NS + number * HOUR_NS - HOUR_NS // 2,
            CHANNELS,
            trigger_index=at_rest,
        )

    def _plant(self, causes: Causes, number: int, random: np.random.Generator) -> MotorPlant:
        """Return the motor as it is at one record: load, supply and warmth vary."""
        usual = self.surroundings
        load = self.usual_load + LOAD_SCATTER * random.standard_normal()
        if Cause.LOAD in causes:
            load += self.load_change
        surroundings = replace(
            usual,
            voltage_V=usual.voltage_V * (1.0 + VOLTAGE_SCATTER * random.standard_normal()),
            frequency_hz=usual.frequency_hz + random.uniform(-0.03, 0.03),
            unbalance=usual.unbalance
            + UNBALANCE_SCATTER * abs(random.standard_normal()) * np.exp(2j * pi * random.uniform()),
        )
        motor, warmth = MOTORS[self.motor], random.uniform(*WARMTH)
        machine = motor.parameters
        self_inductance_H = machine.stator_self_inductance_H
        if Cause.PARAMETERS in causes:  # the motor was exchanged, and its file stayed
            self_inductance_H /= self.sizes.inductance_factor
        machine = replace(
            machine,
            stator_resistance_ohm=warmth * machine.stator_resistance_ohm,
            rotor_resistance_ohm=warmth * machine.rotor_resistance_ohm,
            stator_self_inductance_H=self_inductance_H,
        )
        sizes = replace(self.sizes, unbalance=self.sizes.unbalance + surroundings.unbalance - usual.unbalance)
        return plant_with(
            causes,
            sizes,
            replace(motor, parameters=machine),
            load,
            surroundings,
            seed=1_000 * self.seed + number,
        )
