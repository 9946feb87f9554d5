"""Turns bridged by a resistance: phase, level, load and verdict, on the simulator's windings.

The estimator has no part in the records. How far the simulator's windings, the tests' phase circuits and the
estimator's model agree on such faults is measured beside them.
"""

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from itertools import product
from math import pi

import numpy as np
from numpy.typing import NDArray

from benchmarks.reporting import spread, table
from core.diagnosis.stator import diagnose
from core.diagnosis.verdict import Diagnosis, Verdict
from core.machines.candidates import Candidates
from core.machines.parameters import Motor
from core.machines.running import SteadyRunning
from core.machines.split_winding import SplitWinding
from core.recordings import Recording
from testing.machines.disturbed_records import (
    Disturbances,
    disturbed_record,
    steady_samples,
)
from testing.machines.motors import ALL, MEDIUM, REFERENCE, VERY_LARGE
from testing.machines.steady_faults import Condition, FaultModel, steady

Phasors = NDArray[np.complex128]

RATIOS = (0.0, 0.25, 0.5, 1.0, 2.0, 4.0)
LOADS = ((0.05, 0.2), (0.2, 0.5), (0.5, 1.0))
LEAST_TURNS, MOST_TURNS = 0.06, 0.12
UNBALANCES = (0.0, 0.03)
NOISE = 0.002
SHORTEST_DETECTED = 0.05
"""Equivalent level above which every record is to be called a fault."""
MOTORS = (ALL, (VERY_LARGE,))
"""Motors of a table. The greater X_ls/R_s, the less a path changes the current of the turns."""
LEVEL_SHARE, LOAD_POINTS = 0.1, 0.05
"""Errors of level and load that count as right even outside their intervals."""
SEED = 20_264


@dataclass(frozen=True, slots=True)
class Sensors:
    """Class of a relay's channels: gain errors within `current_gain` and `voltage_gain`, delays up to
    `delay_s`, one for the currents against the voltages, or each channel its own."""

    name: str
    current_gain: float
    voltage_gain: float
    delay_s: float
    of_its_own: bool


GOOD = Sensors("currents within 0.5 %, up to 50 us behind the voltages", 0.005, 0.0, 50e-6, of_its_own=False)
PROTECTION = Sensors("every channel within 1 % and 50 us", 0.01, 0.01, 50e-6, of_its_own=True)


@dataclass(frozen=True, slots=True)
class PathDraw:
    """One random record of a path ratio and a range of loads, of one of the motors."""

    path_ratio: float
    loads: tuple[float, float]
    sensors: Sensors
    index: int
    motors: tuple[Motor, ...] = ALL
    turns: tuple[float, float] = (LEAST_TURNS, MOST_TURNS)


@dataclass(frozen=True, slots=True)
class PathOutcome:
    """The truth and the diagnosis of a draw."""

    motor: Motor
    condition: Condition
    diagnosis: Diagnosis

    @property
    def phase_right(self) -> bool:
        return self.diagnosis.theta_f == self.condition.winding

    @property
    def level_near(self) -> bool:
        truth, found = self.condition.equivalent_level, self.diagnosis.mu_f
        return found is not None and abs(found - truth) <= LEVEL_SHARE * truth

    @property
    def level_right(self) -> bool:
        interval = self.diagnosis.mu_f_ci95
        if interval is None:
            return False
        return self.level_near or interval[0] <= self.condition.equivalent_level <= interval[1]

    @property
    def load_right(self) -> bool:
        truth = self.condition.load_level
        found, interval = self.diagnosis.load_level, self.diagnosis.load_level_ci95
        if found is None or interval is None:
            return False
        return abs(found - truth) <= LOAD_POINTS or interval[0] <= truth <= interval[1]

    @property
    def verdict_right(self) -> bool:
        is_small = self.condition.equivalent_level <= SHORTEST_DETECTED
        return self.diagnosis.verdict is Verdict.FAULT or is_small

    @property
    def right(self) -> bool:
        return self.phase_right and self.level_right and self.load_right and self.verdict_right


def draw_condition(draw: PathDraw) -> tuple[Motor, Condition, Disturbances, float]:
    """Motor, condition, disturbances and the time the window starts at.

    Motors, both sequences and V2/V1 of 0 and 3 % in turn, so that each cell has all of them; windings at
    random; turns, load, gains, delays and the angle of V2 uniform.
    """
    random = np.random.default_rng(
        [SEED, draw.index, round(100 * draw.path_ratio), round(100 * draw.loads[0])]
    )
    motor = draw.motors[draw.index % len(draw.motors)]
    angle = random.uniform(0.0, 2.0 * pi)
    condition = Condition(
        load_level=float(random.uniform(*draw.loads)),
        unbalance=complex(UNBALANCES[draw.index // 6 % 2] * np.exp(1j * angle)),
        level=float(random.uniform(*draw.turns)),
        winding=int(random.integers(3)),
        path_ratio=draw.path_ratio,
        reverse=bool(draw.index // 3 % 2),
    )
    sensors = draw.sensors
    gains = random.uniform(-1.0, 1.0, 6) * np.repeat([sensors.current_gain, sensors.voltage_gain], 3)
    delays = random.uniform(0.0, sensors.delay_s, 6)
    if not sensors.of_its_own:
        delays = np.repeat([delays[0], 0.0], 3)
    disturbances = Disturbances(
        gain_errors=tuple(gains.tolist()), delays_s=tuple(delays.tolist()), noise=NOISE
    )
    return motor, condition, disturbances, float(random.uniform(0.0, 1_000.0))


def record_path(draw: PathDraw) -> tuple[Motor, Condition, Recording]:
    """Make the record of a draw, 0.5 s at 10 kHz."""
    motor, condition, disturbances, start_s = draw_condition(draw)
    record = disturbed_record(
        motor, condition, disturbances, start_s=start_s, cycles=25.0, sample_rate_hz=10_000.0, seed=draw.index
    )
    return motor, condition, record


def judge_path(draw: PathDraw) -> PathOutcome:
    """Make the record of a draw and diagnose it."""
    motor, condition, record = record_path(draw)
    return PathOutcome(motor, condition, diagnose(record, motor))


HEADER = (
    "path", "load", "phase right", "level right", "load right", "`fault` above 5 %", "all right",
    "level off: median, most", "level off by more than 10 %", "interval: half width",
)  # fmt: skip


def resistive_paths(*, records: int, pool: Executor) -> Iterator[str]:
    """A table each for good sensors and for those of protection relays, `records` a cell."""
    for motors, sensors in product(MOTORS, (GOOD, PROTECTION)):
        cells = list(product(RATIOS, LOADS))
        draws = [PathDraw(ratio, loads, sensors, k, motors) for ratio, loads in cells for k in range(records)]
        title = described(motors)
        outcomes = list(spread(judge_path, draws, f"paths, {title}, {sensors.name}", pool))
        yield f"{title}. Sensors: {sensors.name}."
        yield ""
        rows = []
        for k, (ratio, loads) in enumerate(cells):
            here = outcomes[k * records : (k + 1) * records]
            rows.append([f"{ratio:g}", f"{loads[0]:.0%} to {loads[1]:.0%}", *_row(here)])
        yield from table(HEADER, [*rows, ["all", "", *_row(outcomes)]])
        yield ""
    yield from _agreement()


def described(motors: Sequence[Motor]) -> str:
    """Return the ratings of motors and their X_ls/R_s in words."""
    power = ", ".join(f"{motor.nameplate.rated_power_W / 1e3:g} kW" for motor in motors)
    ratio = ", ".join(f"{leakage_ratio(motor):.1f}" for motor in motors)
    return f"{power} with X_ls/R_s of {ratio}"


def leakage_ratio(motor: Motor) -> float:
    """Return X_ls/R_s at the rated frequency."""
    machine = motor.parameters
    w = motor.nameplate.rated_angular_frequency
    return w * machine.stator_leakage_H / machine.stator_resistance_ohm


def _row(outcomes: Sequence[PathOutcome]) -> list[str]:
    n = len(outcomes)
    seen = [one for one in outcomes if one.diagnosis.mu_f is not None]
    off = np.array([(one.diagnosis.mu_f or 0.0) / one.condition.equivalent_level - 1.0 for one in seen])
    widths = [
        (one.diagnosis.mu_f_ci95[1] - one.diagnosis.mu_f_ci95[0]) / 2.0 / one.condition.equivalent_level
        for one in seen
        if one.diagnosis.mu_f_ci95 is not None
    ]
    counted = [one for one in outcomes if one.condition.equivalent_level > SHORTEST_DETECTED]
    faults = sum(one.diagnosis.verdict is Verdict.FAULT for one in counted)
    furthest = float(off[np.argmax(np.abs(off))]) if off.size else 0.0
    return [
        f"{sum(one.phase_right for one in outcomes)} of {n}",
        f"{sum(one.level_right for one in outcomes)} of {n}",
        f"{sum(one.load_right for one in outcomes)} of {n}",
        f"{faults} of {len(counted)}",
        f"{sum(one.right for one in outcomes)} of {n}",
        f"{np.median(off):+.1%}, {furthest:+.1%}" if off.size else "",
        f"{n - sum(one.level_near for one in outcomes)} of {n}",
        f"{np.median(widths):.0%}" if widths else "",
    ]


def _agreement() -> Iterator[str]:
    """Line currents of three models of the same faults, which share no code."""
    of_circuits, of_estimator = [], []
    for motor, ratio, load in product((REFERENCE, MEDIUM), (0.0, 1.0, 4.0), (0.1, 0.8)):
        condition = Condition(load, 0.03, 0.1, 1, path_ratio=ratio)
        operation = steady(motor, FaultModel.SPLIT, condition)
        samples = steady_samples(motor, FaultModel.SPLIT, condition, 5_000, 10_000.0)
        turning = np.exp(-2j * pi * 50.0 / 10_000.0 * np.arange(5_000))
        current, voltage = np.split(np.sqrt(2.0) / 5_000 * samples @ turning, 2)
        size = float(np.abs(current).max())
        circuits = operation.line_current * voltage[0] / operation.phase_voltage[0]
        of_circuits.append(float(np.abs(circuits - current).max()) / size)
        of_estimator.append(float(np.abs(_estimated(motor, condition, voltage) - current).max()) / size)
    yield "Beside the simulator's line currents those of the tests' phase circuits are off by at most"
    yield f"{max(of_circuits):.2%} of the greatest (ripple of the speed), the estimator's by"
    yield f"{max(of_estimator):.3%}."


def _estimated(motor: Motor, condition: Condition, voltage: Phasors) -> Phasors:
    """Line currents of the estimator's split winding in star, rms phasors (3,)."""
    to_axes = np.sqrt(2.0 / 3.0) * np.array([[1.0, -0.5, -0.5], [0.0, np.sqrt(0.75), -np.sqrt(0.75)]])
    w = motor.nameplate.rated_angular_frequency
    running = SteadyRunning(SplitWinding(), motor, w, np.sqrt(2.0) * to_axes @ voltage)
    one = np.ones(1)
    candidate = Candidates(
        condition.equivalent_level * one,
        np.array([condition.winding]),
        condition.load_level * one,
        0.0 * one,
        leakage=one / (1.0 + condition.path_ratio),
    )
    return np.asarray(to_axes.T @ running.state(candidate).current[:, 0] / np.sqrt(2.0))
