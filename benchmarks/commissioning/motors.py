"""Motors with deep bars and leakage that saturates, their starts and their running records.

The physics is the simulator's: two cages of coils, and leakage that falls as an arc tangent does, which is
another law than the one that is estimated.
"""

from dataclasses import dataclass, replace
from math import exp, log, sqrt

import numpy as np

from benchmarks.winding.others import EQUATION_MOTOR
from core.commissioning.commissioning import commission
from core.commissioning.errors import CommissioningError
from core.commissioning.prior import PARAMETERS
from core.commissioning.result import Commissioning
from core.diagnosis.stator import diagnose
from core.machines.deep_bars import DeepBars as Described
from core.machines.parameters import Connection, MachineParameters, Motor, Nameplate
from core.machines.typical import typical_parameters
from ied_sim.motor.deep_bars import UNSATURATED, DeepBars, LeakageSaturation
from ied_sim.motor.load import Load
from ied_sim.motor.plant import MotorPlant, rated_current
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Supply
from testing.machines.disturbed_records import record_of
from testing.machines.starts import StartRecord, plate_of

SMALL = Motor(
    "7.5 kW",
    Nameplate(7_500.0, 400.0, 50.0, 2),
    MachineParameters(0.62, 0.42, 0.0042, 0.0042, 0.083, 0.05),
)
LARGE = Motor(
    "160 kW",
    Nameplate(160_000.0, 400.0, 50.0, 2, Connection.DELTA),
    MachineParameters(0.042, 0.03, 0.0006, 0.0006, 0.0165, 2.9),
)
KNEE = 2.0
"""Current i_0 of the saturation, over the rated amplitude."""
SNR_DB = 46.0
RUN_UP_SHARE = 1.6
"""Length of a record over the run-up with rated torque beyond the load's."""
RUNNING_LOADS = (0.3, 0.6, 1.0)
RATE_HZ = 5_000.0
STEP_S = 0.001
"""Time in which a load steps in."""
STEPPED_FROM = 0.2
"""Load over the rated torque before it does."""


@dataclass(frozen=True, slots=True)
class Case:
    """A motor, and what of it changes from a start to running. seed: of load and noise.

    load_change: how the load changes during the start, as a StartRecord has it; None where it stays.
    """

    name: str
    motor: Motor
    bars: DeepBars | None
    saturating: float
    load_level: float
    duration_s: float
    seed: int = 0
    load_change: tuple[float, float, float] | None = None

    @property
    def saturation(self) -> LeakageSaturation:
        if self.saturating == 0.0:
            return UNSATURATED
        per_line = sqrt(3.0) if self.motor.nameplate.connection is Connection.DELTA else 1.0
        return LeakageSaturation(self.saturating, KNEE * sqrt(2.0) * rated_current(self.motor) / per_line)


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of one case.

    errors: of each parameter, relative; None where it was not told.  held: whether the interval holds the
    truth.  speed_rpm: largest error of the speed of running records.  refused: why nothing was estimated.
    load_change: what is said of the load: a step, a rise, "unexplained", or nothing.
    """

    case: Case
    errors: dict[str, float | None]
    held: dict[str, bool]
    changes: bool
    speed_rpm: float | None
    slip_share: float | None
    seconds: float
    refused: str = ""
    load_change: str = ""


def tried(case: Case) -> Outcome:
    """Record a start of a motor, estimate its parameters, and look at its speed while it runs."""
    record = StartRecord(
        load_level=case.load_level,
        duration_s=case.duration_s,
        snr_db=SNR_DB,
        seed=case.seed,
        deep_bars=case.bars,
        leakage_saturation=case.saturation,
        load_change=case.load_change,
    ).of(case.motor)
    try:
        found = commission([record], plate_of(case.motor))
    except CommissioningError as error:
        nothing: dict[str, float | None] = dict.fromkeys(PARAMETERS)
        return Outcome(
            case, nothing, {}, changes=False, speed_rpm=None, slip_share=None, seconds=0.0, refused=str(error)
        )
    errors: dict[str, float | None] = {}
    held = {}
    for name in PARAMETERS:
        one, truth = found.parameters[name], float(getattr(case.motor.parameters, name))
        errors[name] = None if one.ci95 is None else one.value / truth - 1.0
        if one.ci95 is not None:
            held[name] = one.ci95[0] <= truth <= one.ci95[1]
    rpm, share = _speed(case, found.motor)
    return Outcome(
        case,
        errors,
        held,
        bool(found.change),
        rpm,
        share,
        found.compute_seconds,
        load_change=_of_load(found),
    )


def _of_load(found: Commissioning) -> str:
    change = found.starts[0].load_change
    if change is not None:
        return "step" if change.is_step else "rise"
    return "unexplained" if any("noise does not explain" in one for one in found.warnings) else ""


def _speed(case: Case, known: Motor) -> tuple[float | None, float | None]:
    """Return the largest errors of the speed of running records: in rpm, and of the slip over itself."""
    plate = case.motor.nameplate
    apart, shares = [], []
    for level in RUNNING_LOADS:
        plant = MotorPlant(
            case.motor,
            Supply(plate.rated_voltage_V, plate.rated_frequency_Hz),
            Load(level),
            Sensors(1.0, 1.0),
            deep_bars=case.bars,
            leakage_saturation=case.saturation,
        )
        true = plant.operation(0.0, 0.5, RATE_HZ)
        samples = np.vstack([true.currents_A, true.voltages_V])
        found = diagnose(record_of(samples, RATE_HZ), known)
        if found.speed_rpm is None:
            return None, None
        truth_rpm = 60.0 / (2.0 * np.pi) * float(true.speed_rad_s.mean())
        apart.append(abs(found.speed_rpm - truth_rpm))
        shares.append(apart[-1] / (plate.synchronous_rpm - truth_rpm))
    return max(apart), max(shares)


def of_issue() -> list[Case]:
    """A motor of one loop, and those whose rotor has 1.6 and 2.3 times the resistance at standstill."""
    cases = []
    for motor, seconds in ((SMALL, 1.0), (LARGE, 2.5)):
        for ratio, saturating in ((1.0, 0.0), (1.6, 0.2), (2.3, 0.4)):
            bars = None if ratio == 1.0 else _with_ratio_at_standstill(motor, ratio)
            power = f"{motor.nameplate.rated_power_W / 1e3:g} kW"
            cases.append(Case(f"{power}, {ratio:g} at standstill", motor, bars, saturating, 0.5, seconds))
    return cases


def of_steps() -> list[Case]:
    """A motor of 6.1 and 3.152 ohm, whose load steps in early, half-way or late, in records of 1 and 3 s."""
    steps = (
        (1.0, 0.3, 0.2), (1.0, 0.3, 0.5), (1.0, 0.3, 0.8), (1.0, 0.8, 0.5),
        (3.0, 0.3, 0.3), (3.0, 0.3, 2.0), (3.0, 0.8, 1.0),
    )  # fmt: skip
    return [
        Case(
            f"{seconds:g} s, {change:.0%} at {at_s:g} s",
            EQUATION_MOTOR, None, 0.0, STEPPED_FROM, seconds, seed=1, load_change=(change, at_s, STEP_S),
        )
        for seconds, change, at_s in steps
    ]  # fmt: skip


def _with_ratio_at_standstill(motor: Motor, ratio: float) -> DeepBars:
    """Return bars of so much resistance at standstill: the least ratio at a great slip that gives it."""
    machine, w = motor.parameters, motor.nameplate.rated_angular_frequency
    for share in (0.8, 0.6, 0.4, 0.2, 0.1, 0.05):
        for great in np.geomspace(ratio, 18.0, 200):
            seen = Described(float(great), share).seen_at(
                w, machine.rotor_resistance_ohm, machine.rotor_leakage_H
            )
            if seen.resistance_ratio >= ratio:
                return DeepBars(float(great), share)
    raise ValueError(f"no bars of {ratio:g} times the resistance at standstill")


def drawn(seed: int) -> Case:
    """Draw a motor of 0.5 kW to 2 MW with two loops and leakage that saturates."""
    random = np.random.default_rng([seed, 43])
    power_W = exp(random.uniform(log(500.0), log(2e6)))
    medium = power_W > 400e3
    plate = Nameplate(
        power_W,
        6_000.0 if medium else 400.0,
        50.0,
        int(random.integers(1, 4)),
        Connection.STAR if medium or random.uniform() < 0.5 else Connection.DELTA,
    )
    machine = _machine(plate, random)
    level = float(random.uniform(0.05, 0.6))
    return Case(
        f"{power_W / 1e3:.3g} kW",
        Motor("drawn", plate, machine),
        DeepBars(float(random.uniform(1.3, 5.0)), float(random.uniform(0.35, 0.85))),
        float(random.uniform(0.05, 0.45)),
        level,
        float(np.clip(RUN_UP_SHARE * _run_up_s(machine, plate), 0.6, 3.0)),
        seed,
    )


def drawn_load(seed: int, kind: str) -> Case:
    """Draw a motor of 0.8 to 160 kW, every third with deep bars, whose load steps, rises or stays."""
    random = np.random.default_rng([seed, 45])
    power_W = exp(random.uniform(log(800.0), log(160e3)))
    plate = Nameplate(power_W, 400.0, 50.0, int(random.integers(1, 4)))
    machine = _machine(plate, random)
    level = float(random.uniform(0.05, 0.4))
    duration_s = float(np.clip(RUN_UP_SHARE * _run_up_s(machine, plate), 0.6, 1.5))
    change, at = float(random.uniform(0.1, 0.5)), float(random.uniform(0.1, 0.7))
    lasts_s = float(random.uniform(0.1, 0.8)) * (1.0 - at) * duration_s
    has_bars = seed % 3 == 2
    return Case(
        f"{power_W / 1e3:.3g} kW",
        Motor("drawn", plate, machine),
        DeepBars(float(random.uniform(1.3, 3.0)), float(random.uniform(0.35, 0.85))) if has_bars else None,
        float(random.uniform(0.05, 0.45)) if has_bars else 0.0,
        level,
        duration_s,
        seed,
        None if kind == "constant" else (change, at * duration_s, STEP_S if kind == "step" else lasts_s),
    )


def _machine(plate: Nameplate, random: np.random.Generator) -> MachineParameters:
    """Draw parameters about those typical of the rating."""
    typical = typical_parameters(plate).parameters
    factor = {name: exp(0.2 * random.normal()) for name in PARAMETERS}
    return replace(
        typical,
        **{name: float(getattr(typical, name)) * factor[name] for name in PARAMETERS},
        rotor_leakage_H=typical.rotor_leakage_H * factor["stator_leakage_H"],
    )


def _run_up_s(machine: MachineParameters, plate: Nameplate) -> float:
    """Return how long a start with the rated torque takes."""
    synchronous = plate.rated_angular_frequency / plate.pole_pairs
    return machine.inertia_kgm2 * synchronous / plate.rated_torque_Nm
