"""Motors whose parameters change in the middle of their records, and what is true of them then."""

from dataclasses import dataclass, replace
from math import log
from typing import Final

import numpy as np

from benchmarks.condition.courses import Course, healthy
from benchmarks.condition.operation import COPPER_PER_K, Operation, draw_kind_of_times, draw_operation
from benchmarks.condition.population import LEAST_POWER_W, MOST_POWER_W, SimulatedMotor, draw_motor
from benchmarks.condition.records import REAL_NOISE, measure
from core.condition.observation import Observation
from core.machines.parameters import Motor
from core.tracking.finding import DriftCause, ParameterName

HOTTER_K: Final = 50.0


@dataclass(frozen=True, slots=True)
class Happening:
    """What changes from one record to the next.

    cause: what it is to be told as; None for nothing.  drifting: the parameters that are to be told.
    resistance, magnetising: factors of R_r and L_m.  hotter_K: of both windings.  ratio: of the currents,
    which are read so many times too small.  starts: whether the motor is started every hundred records.
    """

    cause: DriftCause | None = None
    drifting: tuple[ParameterName, ...] = ()
    resistance: float = 1.0
    magnetising: float = 1.0
    hotter_K: float = 0.0
    ratio: float = 1.0
    starts: bool = False


_ROTOR = (ParameterName.ROTOR_RESISTANCE,)
_MAGNETISING = (ParameterName.MAGNETISING_INDUCTANCE,)
HAPPENINGS: Final = {
    "nothing": Happening(),
    "R_r +10 %": Happening(DriftCause.ROTOR, _ROTOR, resistance=1.1),
    "R_r +20 %": Happening(DriftCause.ROTOR, _ROTOR, resistance=1.2),
    "R_r +10 %, with starts": Happening(DriftCause.ROTOR, _ROTOR, resistance=1.1, starts=True),
    "R_r +20 %, with starts": Happening(DriftCause.ROTOR, _ROTOR, resistance=1.2, starts=True),
    "both windings 50 K hotter": Happening(
        DriftCause.WINDING_HOT, (ParameterName.STATOR_RESISTANCE,), hotter_K=HOTTER_K
    ),
    "ratio 2 % wrong": Happening(DriftCause.RATIO, _MAGNETISING, ratio=1.02),
    "L_m -10 %": Happening(DriftCause.MAGNETISING, _MAGNETISING, magnetising=0.9),
}


@dataclass(frozen=True, slots=True)
class Followed:
    """A motor as its file has it, its records, and what its starts tell of R_r over R_s, by record.

    magnetising_change: true change of L_M = L_m^2 / (L_m + L_lr).
    """

    motor: Motor
    records: list[Observation]
    starts: dict[int, float]
    magnetising_change: float


START_EVERY, START_SCATTER = 100, 0.015
"""Records from one start to the next; standard deviation of what commissioning tells of one."""
FIRST_START = 5


def draw(happening: Happening, seed: int, records: int, first: int) -> Followed:
    """Draw a motor with its operation; what happens begins with the record `first`."""
    random = np.random.default_rng([seed, 2024])
    simulated = draw_motor(random)
    size = log(simulated.motor.nameplate.rated_power_W / LEAST_POWER_W) / log(MOST_POWER_W / LEAST_POWER_W)
    operation = draw_operation(random, records, times=draw_kind_of_times(random), size=size)
    operation, course = _changed(happening, simulated, operation, first)
    observations = measure(random, simulated, operation, course, REAL_NOISE).observations()
    starts = {}
    if happening.starts:
        true = float(simulated.windings.rotor_resistance_ohm[0] / simulated.windings.stator_resistance_ohm[0])
        for at in range(FIRST_START, records, START_EVERY):
            factor = happening.resistance if at >= first else 1.0
            # Skin effect in the cage at standstill stays as it is; windings are not alike warm.
            alike = 1.0 + random.normal(0.0, START_SCATTER) + random.uniform(-0.05, 0.05)
            starts[at] = 1.2 * true * factor * alike
    windings = simulated.windings
    L_m, L_lr = float(windings.magnetising_H[0]), float(windings.rotor_leakage_H[0])
    factor = happening.magnetising
    change = factor**2 * (L_m + L_lr) / (factor * L_m + L_lr) * happening.ratio - 1.0
    return Followed(simulated.motor, observations, starts, change)


def _changed(
    happening: Happening, simulated: SimulatedMotor, operation: Operation, first: int
) -> tuple[Operation, Course]:
    records = len(operation)
    late = np.arange(records) >= first
    course = healthy(records)
    other = replace(
        simulated.windings,
        rotor_resistance_ohm=happening.resistance * simulated.windings.rotor_resistance_ohm,
        magnetising_H=happening.magnetising * simulated.windings.magnetising_H,
    )
    ratio = np.where(late, 1.0 / happening.ratio, 1.0)[:, np.newaxis]
    course = replace(course, rewound=(first, other), current_ratio=course.current_ratio * ratio)
    hotter = happening.hotter_K * COPPER_PER_K * late
    return replace(operation, warming=operation.warming + hotter), course
