"""What is no fault: channels, relays, windings, joints and the supply; how often it is called one."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from benchmarks.condition.courses import (
    Course,
    healthy,
    shape,
    with_current_error,
    with_joint,
    with_other_relay,
    with_rewinding,
    with_unbalance,
    with_voltage_error,
)
from benchmarks.condition.following import Outcome, follow, judged_around, outcome
from benchmarks.condition.marks import Mark, at_least, at_most
from benchmarks.condition.operation import draw_operation
from benchmarks.condition.population import SimulatedMotor, draw_motor
from benchmarks.condition.records import HARSH_NOISE, REAL_NOISE, measure
from benchmarks.reporting import rate_text, spread, table
from core.condition.kinds import Kind, State

BEFORE = (60, 140)
AFTER = 300
CHANNEL_ERRORS = (0.003, 0.02)
"""Of a channel that steps or drifts, either way."""
DIRECTION = 0.1
"""Scatter of a channel's error about a pure gain [rad]."""
DRIFT_RECORDS = (20, 200)
JOINT_DROPS = (0.002, 0.02)
"""At rated current, over the rated voltage of a phase."""
SUPPLY_STEPS = (0.01, 0.04)
MOST_CALLED = 0.02
"""Of each of the channels, the relay and the supply."""
MOST_STEPS_CALLED = 2 / 300
MOST_JOINTS_CALLED = 0.24


class Disturbance(StrEnum):
    """What happens to a healthy motor or to what measures it."""

    VOLTAGE_STEP = "voltage channel, step"
    VOLTAGE_DRIFT = "voltage channel, drift"
    CURRENT_STEP = "current channel, step"
    CURRENT_DRIFT = "current channel, drift"
    RELAY_TOLD = "relay exchanged, announced"
    RELAY_UNTOLD = "relay exchanged, unannounced"
    REWOUND = "rewound, unannounced"
    SUPPLY = "supply, step of V2/V1"
    QUIET_SUPPLY = "supply, step of a V2/V1 that was constant"
    JOINT_STEP = "joint, step"
    JOINT_GROWTH = "joint, growth"


JOINTS = (Disturbance.JOINT_STEP, Disturbance.JOINT_GROWTH)
"""A real defect of the motor's circuit, which at constant load cannot be told from shorted turns."""


CHANNELS = (
    Disturbance.VOLTAGE_STEP, Disturbance.VOLTAGE_DRIFT, Disturbance.CURRENT_STEP, Disturbance.CURRENT_DRIFT,
)  # fmt: skip
RELAYS = (Disturbance.RELAY_TOLD, Disturbance.RELAY_UNTOLD)
SUPPLIES = (Disturbance.SUPPLY, Disturbance.QUIET_SUPPLY)


@dataclass(frozen=True, slots=True)
class Task:
    """One motor with a disturbance, by its number."""

    disturbance: Disturbance
    number: int
    noise: float


@dataclass(frozen=True, slots=True)
class Result:
    """What came of a disturbance; worded: whether each `fault` was said to be a joint or shorted turns."""

    outcome: Outcome
    worded: bool

    @property
    def called(self) -> bool:
        return self.outcome.called_fault is not None

    @property
    def alarmed(self) -> bool:
        return self.outcome.seen is not None or self.outcome.alarmed_before or self.called


def disturbed(
    kind: Disturbance, random: np.random.Generator, motor: SimulatedMotor, records: int, first: int
) -> Course:
    """A course in which the disturbance begins at a record, of a random size and in a random channel."""
    course = healthy(records)
    place = int(random.integers(3))
    sudden = shape(records, first)
    slow = shape(records, first, int(random.integers(*DRIFT_RECORDS)))
    error = random.uniform(*CHANNEL_ERRORS) * random.choice([-1.0, 1.0])
    channel_error = complex(error * np.exp(1j * random.normal(0.0, DIRECTION)))
    joint_ohm = random.uniform(*JOINT_DROPS) * motor.rated_line_impedance_ohm
    unbalance = complex(random.uniform(*SUPPLY_STEPS) * np.exp(2j * np.pi * random.uniform()))
    match kind:
        case Disturbance.VOLTAGE_STEP:
            return with_voltage_error(course, place, channel_error, sudden)
        case Disturbance.VOLTAGE_DRIFT:
            return with_voltage_error(course, place, channel_error, slow)
        case Disturbance.CURRENT_STEP:
            return with_current_error(course, place, channel_error, sudden)
        case Disturbance.CURRENT_DRIFT:
            return with_current_error(course, place, channel_error, slow)
        case Disturbance.RELAY_TOLD | Disturbance.RELAY_UNTOLD:
            told = kind is Disturbance.RELAY_TOLD
            return with_other_relay(random, course, motor, first, announced=told)
        case Disturbance.REWOUND:
            return with_rewinding(random, course, motor, first)
        case Disturbance.SUPPLY | Disturbance.QUIET_SUPPLY:
            return with_unbalance(course, unbalance, sudden)
        case Disturbance.JOINT_STEP:
            return with_joint(course, place, joint_ohm, sudden)
        case Disturbance.JOINT_GROWTH:
            return with_joint(course, place, joint_ohm, slow)


def follow_disturbance(task: Task) -> Result:
    """Simulate a motor with a disturbance and follow it for 300 records after it."""
    random = np.random.default_rng([task.number, 3, list(Disturbance).index(task.disturbance)])
    simulated = draw_motor(random)
    first = int(random.integers(BEFORE[0], BEFORE[1] + 1))
    records = first + AFTER
    operation = draw_operation(random, records)
    if task.disturbance is Disturbance.QUIET_SUPPLY:
        operation = operation.on_constant_supply()
    course = disturbed(task.disturbance, random, simulated, records, first)
    observations = measure(random, simulated, operation, course, task.noise).observations()
    said = list(follow(simulated.motor, observations, judged_around(first, records)))
    faults = [one for one in said if one.condition.state is State.FAULT]
    return Result(outcome(said, first), worded=all(Kind.CONNECTION in one.kinds for one in faults))


def disturbances(motors: int, pool: Executor) -> Iterator[str | Mark]:
    """Marks, and tables of how often each is called a fault, and what each is named."""
    lines: list[str] = []
    for noise, name in ((REAL_NOISE, "real"), (HARSH_NOISE, "harsh")):
        found: dict[Disturbance, list[Result]] = {}
        for kind in Disturbance:
            tasks = [Task(kind, number, noise) for number in range(motors)]
            found[kind] = list(spread(follow_disturbance, tasks, f"{name}, {kind.value}", pool))
        if name == "real":
            yield from _floors(found)
        yield from _ceilings(name, found)
        rows = [
            [kind.value, rate_text(_called(every), len(every)), *outcome_row([one.outcome for one in every])]
            for kind, every in found.items()
        ]
        header = ["disturbance", "called `fault`", "seen", "in the end"]
        lines += [f"Noise {name}:", "", *table(header, rows), ""]
    yield from lines


def _floors(found: Mapping[Disturbance, Sequence[Result]]) -> Iterator[Mark]:
    """What a study of the method reached at real noise."""
    for kind in (
        Disturbance.VOLTAGE_STEP, Disturbance.VOLTAGE_DRIFT, Disturbance.CURRENT_STEP,
        Disturbance.RELAY_UNTOLD, Disturbance.REWOUND,
    ):  # fmt: skip
        most = MOST_STEPS_CALLED if kind is Disturbance.VOLTAGE_STEP else 0.0
        yield at_most(f"{kind.value}, real: called `fault`", _called(found[kind]), len(found[kind]), most)
    for kind in SUPPLIES:
        every = found[kind]
        yield at_most(f"{kind.value}, real: any alarm", sum(one.alarmed for one in every), len(every), 0.0)
    joints = [one for kind in JOINTS for one in found[kind]]
    yield at_most("joint, real: called `fault`", _called(joints), len(joints), MOST_JOINTS_CALLED)
    called = [one for one in joints if one.called]
    worded = sum(one.worded for one in called)
    yield at_least("joint called `fault`, real: worded as turns or a joint", worded, len(called), 1.0)


def _ceilings(name: str, found: Mapping[Disturbance, Sequence[Result]]) -> Iterator[Mark]:
    """What is asked of each disturbance at any noise: the worst of its kinds is told."""
    for what, kinds in (("channels", CHANNELS), ("relay", RELAYS), ("supply", SUPPLIES)):
        worst = max(kinds, key=lambda kind: _called(found[kind]) / len(found[kind]))
        every = found[worst]
        kind = f"{worst.value}, the worst" if _called(every) else f"{what}, any change"
        yield at_most(f"{kind}, {name}: called `fault`", _called(every), len(every), MOST_CALLED)


def _called(found: Sequence[Result]) -> int:
    return sum(one.called for one in found)


def outcome_row(found: list[Outcome]) -> list[str]:
    """How many were seen, and how often each kind or pair of kinds was named in the end."""
    named = Counter(_names(one.final) for one in found)
    seen = sum(one.seen is not None for one in found)
    return [f"{seen / len(found):.2f}", ", ".join(f"{name} {count}" for name, count in named.most_common(5))]


def _names(kinds: tuple[Kind, ...]) -> str:
    return " or ".join(sorted(str(kind) for kind in kinds)) or "none"
