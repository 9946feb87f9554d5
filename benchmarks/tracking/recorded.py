"""Drifts in recordings of the simulator: each is examined as a service does, then followed."""

from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.reporting import Section, spread, table
from benchmarks.tracking.motors import HAPPENINGS
from core.condition.observation import Observation
from core.findings.examining import examine
from core.tracking.drift import FOLLOWED
from core.tracking.finding import DriftCause
from core.tracking.follower import REFERENCE_RECORDS, Follower
from core.tracking.telling import tracked_parameters
from core.units import NANOSECONDS_PER_SECOND
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant, rated_current
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply
from ied_sim.motor.warming import Warming
from testing.machines.disturbed_records import record_of
from testing.machines.motors import ALL

RATE_HZ, LENGTH_S, HOUR_S = 4_000.0, 0.32, 3600
BEFORE, AFTER = REFERENCE_RECORDS + 15, 30
QUICK_AFTER = 5
RISE_K = 60.0
NAMES = ("nothing", "R_r +20 %", "both windings 50 K hotter", "ratio 2 % wrong", "L_m -10 %")
OFF = (1.03, 0.95, 0.96, 1.04, 0.97)
"""True R_s, R_r, L_ls, L_lr and L_s over those of the file."""
GAINS = (0.002, -0.003, 0.001, 0.002, -0.001, 0.003)


@dataclass(frozen=True, slots=True)
class Case:
    """A motor by its place in ALL, and what happens to it."""

    motor: int
    name: str
    after: int


@dataclass(frozen=True, slots=True)
class Result:
    """found_after: records until the drift was told; early: whether one was before.  causes: at the end."""

    case: Case
    early: bool
    found_after: int | None
    causes: tuple[DriftCause, ...]
    changes: tuple[float, ...]
    halves: tuple[float, ...]


def sections(pool: Executor, *, quick: bool) -> list[Section]:
    """One table."""
    names = NAMES[:1] if quick else NAMES
    cases = [Case(m, name, QUICK_AFTER if quick else AFTER) for m in range(len(ALL)) for name in names]
    results = list(spread(followed, cases, "recordings", pool))
    lines = [
        f"Three motors with {BEFORE} recordings of {LENGTH_S:g} s before and {AFTER} after the change: load "
        f"30 to 100 %, unbalance of the supply 0.5 % at any angle, windings that warm up by {RISE_K:g} K, "
        "noise of 0.2 %, parameters 3 to 5 % beside the file's.",
        "",
        *table(
            [
                "motor",
                "what happens",
                "told before",
                "told after",
                "causes",
                "changes, half intervals [%]",
            ],
            [_row(one) for one in results],
        ),
        "",
        "Changes: R_s, leakage, magnetising inductance, R_r. So few records tell R_r to 10 % at best. "
        "50 K are 20 % of R_s: where the interval lies below, the follower has not got there.",
    ]
    command = "python -m benchmarks.tracking --subject recorded"
    return [Section("recorded", "Through recordings", command, tuple(lines))]


def followed(case: Case) -> Result:
    """Follow one motor."""
    follower, happening = Follower(ALL[case.motor]), HAPPENINGS[case.name]
    early, found_after = False, None
    for number in range(BEFORE + case.after):
        follower.follow(_observed(case, number))
        drifting = {one for one, drift in zip(FOLLOWED, follower.drifts, strict=True) if drift.since_ns}
        early |= bool(drifting) and number < BEFORE
        if number >= BEFORE and found_after is None and drifting & set(happening.drifting):
            found_after = number - BEFORE + 1
    change, covariance = follower.changes
    halves = 1.96 * np.sqrt(np.diag(covariance))
    causes = tracked_parameters(follower).causes
    return Result(case, early, found_after, causes, tuple(change.tolist()), tuple(halves.tolist()))


def _observed(case: Case, number: int) -> Observation:
    motor, happening = ALL[case.motor], HAPPENINGS[case.name]
    random = np.random.default_rng([case.motor, number])
    late, plate = number >= BEFORE, motor.nameplate
    factors = np.array(OFF)
    if late:
        factors = factors * np.array([1.0, happening.resistance, 1.0, 1.0, happening.magnetising])
    true = replace(motor.parameters, **dict(zip(_FIGURES, factors * _figures(case.motor), strict=True)))
    level = random.uniform(0.3, 1.0)
    scale = 1.0 / happening.ratio - 1.0 if late else 0.0
    plant = MotorPlant(
        replace(motor, parameters=true),
        Supply(
            plate.rated_voltage_V * random.uniform(0.97, 1.03),
            plate.rated_frequency_Hz,
            unbalance=0.005,
            unbalance_angle_rad=random.uniform(0.0, 2.0 * np.pi),
        ),
        Load(level),
        Sensors(
            10.0 * rated_current(motor),
            2.0 * plate.rated_voltage_V,
            gain_errors=(*(gain + scale for gain in GAINS[:3]), *GAINS[3:]),
            noise=2e-3,
        ),
        seed=number,
        warming=Warming(
            rise_K=RISE_K, begin_s=-1e6, ambient_K=random.normal(0.0, 3.0) + late * happening.hotter_K
        ),
    )
    record = record_of(plant.window(20.0, LENGTH_S, RATE_HZ, step_rate_hz=10_000.0), RATE_HZ)
    dated = replace(record, start_time_ns=number * HOUR_S * NANOSECONDS_PER_SECOND)
    observation = examine(dated, motor).observation
    if observation is None:
        raise RuntimeError(f"the quality gate refused record {number} of {motor.name}, {case.name}")
    return observation


_FIGURES = (
    "stator_resistance_ohm",
    "rotor_resistance_ohm",
    "stator_leakage_H",
    "rotor_leakage_H",
    "stator_self_inductance_H",
)


def _figures(motor: int) -> np.typing.NDArray[np.float64]:
    return np.array([getattr(ALL[motor].parameters, name) for name in _FIGURES])


def _row(result: Result) -> list[str]:
    parameters = result.case
    after = "not" if result.found_after is None else f"after {result.found_after} records"
    if HAPPENINGS[parameters.name].cause is None:
        after = "-"
    changes = ", ".join(
        f"{100 * change:+.1f} ({100 * half:.1f})"
        for change, half in zip(result.changes, result.halves, strict=True)
    )
    return [
        ALL[parameters.motor].name,
        parameters.name,
        "yes" if result.early else "no",
        after,
        ", ".join(map(str, result.causes)) or "-",
        changes,
    ]
