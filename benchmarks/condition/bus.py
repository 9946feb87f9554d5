"""Five motors on one bus: channels judged against each other, and motors faulty from the beginning."""

from collections import Counter
from collections.abc import Container, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from benchmarks.condition.courses import Course, healthy, shape, with_fault, with_unbalance
from benchmarks.condition.disturbances import Disturbance, disturbed, outcome_row
from benchmarks.condition.following import Outcome, Said, judged_around, outcome, quantile_text, said_of
from benchmarks.condition.operation import Operation, draw_operation
from benchmarks.condition.population import SENSOR_CLASSES, SimulatedMotor, draw_motor, draw_site
from benchmarks.condition.records import REAL_NOISE, measure
from benchmarks.reporting import mark, rate_text, spread, table
from core.condition.bus.neighbours import neighbour_of
from core.condition.following.follower import Follower
from core.condition.kinds import State
from core.condition.observation import Observation
from core.machines.sensors import SensorClass

MOTORS = 5
BEFORE, AFTER = 100, 150
APART = 1e-4
"""Of V2/V1 between records of a bus, which are made within a minute."""
GROWTH = 1e-4
"""Of the level, a record."""
STANDING_LEVELS = (0.005, 0.0075, 0.01, 0.02)
STANDING_RECORDS = 100
COARSE = SensorClass(0.01, 0.01, 50e-6, 50e-6)
MOST_CALLED = 0.01


class Case(StrEnum):
    """What happens to the first motor of a bus."""

    VOLTAGE_STEP = "voltage channel, step"
    VOLTAGE_DRIFT = "voltage channel, drift"
    CURRENT_STEP = "current channel, step"
    RELAY = "relay exchanged, unannounced"
    SUPPLY = "supply of the bus, step of V2/V1"
    GROWTH = "growth of 0.01 % a record"
    STANDING = "faulty from the first record on"


class Transformers(StrEnum):
    """Whose transformers the relays of a bus measure its voltages by."""

    OWN = "own"
    COMMON = "common, stated"
    UNSTATED = "common, not stated"
    """The motors file says nothing of it, so that the motors are compared as if each had its own."""


DISTURBANCES = {
    Case.VOLTAGE_STEP: Disturbance.VOLTAGE_STEP,
    Case.VOLTAGE_DRIFT: Disturbance.VOLTAGE_DRIFT,
    Case.CURRENT_STEP: Disturbance.CURRENT_STEP,
    Case.RELAY: Disturbance.RELAY_UNTOLD,
}


@dataclass(frozen=True, slots=True)
class Task:
    """One bus, by its number."""

    case: Case
    number: int
    transformers: Transformers = Transformers.OWN
    level: float = 0.0
    sensors: SensorClass | None = None
    motors: int = MOTORS


@dataclass(frozen=True, slots=True)
class Result:
    """What came of the first motor, whether its phase is right, and how many others were called a fault."""

    outcome: Outcome
    right: bool
    others_called: int


def follow_bus(task: Task) -> Result:
    """Simulate a bus and follow its motors together."""
    random = np.random.default_rng([task.number, 4, list(Case).index(task.case)])
    site = draw_site(random)
    sensors = task.sensors
    if sensors is None and task.transformers is not Transformers.OWN:
        # What is common is of one class, and all files state it.
        sensors = SENSOR_CLASSES[int(random.integers(len(SENSOR_CLASSES)))]
    motors = [draw_motor(random, site=site, sensors=sensors) for _ in range(task.motors)]
    motors = [replace(one, motor=replace(one.motor, name=f"motor {k}")) for k, one in enumerate(motors)]
    if task.transformers is not Transformers.OWN:
        # One transformer: the same errors for all, and it measures phases or lines for all.
        motors = [
            replace(
                one,
                channels=replace(one.channels, voltage=motors[0].channels.voltage),
                voltage_channels=motors[0].voltage_channels,
            )
            for one in motors
        ]
    first = 0 if task.case is Case.STANDING else BEFORE
    records = STANDING_RECORDS if task.case is Case.STANDING else BEFORE + AFTER
    supply = draw_operation(random, records)
    winding = int(random.integers(3))
    courses = _courses(task, random, motors, records, winding)
    every = [
        measure(random, one, _at_the_bus(random, supply, records), course, REAL_NOISE).observations()
        for one, course in zip(motors, courses, strict=True)
    ]
    said, others_called = _follow_together(
        motors, every, judged_around(first, records), compared=task.transformers is not Transformers.COMMON
    )
    found = outcome(said, first)
    place = "abc"[motors[0].terminal(winding)]
    return Result(found, found.phase == place, others_called)


def _courses(
    task: Task, random: np.random.Generator, motors: Sequence[SimulatedMotor], records: int, winding: int
) -> list[Course]:
    courses = [healthy(records) for _ in motors]
    if task.case is Case.SUPPLY:
        size = complex(random.uniform(0.01, 0.04) * np.exp(2j * np.pi * random.uniform()))
        return [with_unbalance(one, size, shape(records, BEFORE)) for one in courses]
    if task.case is Case.GROWTH:
        level = GROWTH * np.maximum(0.0, np.arange(records) - BEFORE + 1.0)
        courses[0] = with_fault(courses[0], winding, level, float(random.choice([0.0, 1.0, 3.0])))
    elif task.case is Case.STANDING:
        level = np.full(records, task.level)
        courses[0] = with_fault(courses[0], winding, level, float(random.choice([0.0, 1.0, 3.0])))
    else:
        courses[0] = disturbed(DISTURBANCES[task.case], random, motors[0], records, BEFORE)
        if task.transformers is not Transformers.OWN:
            seen = courses[0].voltage_ratio
            courses = [courses[0], *(replace(one, voltage_ratio=seen) for one in courses[1:])]
    return courses


def _at_the_bus(random: np.random.Generator, supply: Operation, records: int) -> Operation:
    """A motor's own load and warmth at the bus's voltages, which wander between the records of a minute."""
    own = draw_operation(random, records).on_supply(supply)
    apart = random.standard_normal(records) + 1j * random.standard_normal(records)
    return replace(own, time_ns=supply.time_ns, unbalance=own.unbalance + APART / np.sqrt(2) * apart)


def _follow_together(
    motors: Sequence[SimulatedMotor],
    every: Sequence[Sequence[Observation]],
    judged: Container[int],
    *,
    compared: bool,
) -> tuple[list[Said], int]:
    """What is said of the first motor after each record; how many others were a fault at their last.

    compared: with each other, as the service does it unless it is told of a common transformer.
    """
    followers = [Follower(one.motor) for one in motors]
    said = []
    for number, records in enumerate(zip(*every, strict=True)):
        seen = [neighbour_of(one.motor, record) for one, record in zip(motors, records, strict=True)]
        for k, (follower, record) in enumerate(zip(followers, records, strict=True)):
            follower.fold(record, [*seen[:k], *seen[k + 1 :]] if compared else [])
        if number in judged:
            said.append(_said(followers, motors, 0, number, compared))
    others = [_said(followers, motors, k, number, compared) for k in range(1, len(motors))]
    return said, sum(one.condition.state is State.FAULT for one in others)


def _said(
    followers: Sequence[Follower], motors: Sequence[SimulatedMotor], k: int, record: int, compared: bool
) -> Said:
    others = [one for j, one in enumerate(followers) if j != k] if compared else []
    estimates = [one.standing_estimate() for one in others]
    known = [one for one in estimates if one is not None]
    return said_of(followers[k], motors[k].motor, record, known)


def bus(buses: int, pool: Executor) -> Iterator[str]:
    """Tables of what comes to a bus, and of motors that are faulty from the first record on."""
    rows = []
    called = total = others = 0
    for transformers in (Transformers.OWN, Transformers.COMMON):
        for case in (*DISTURBANCES, Case.SUPPLY):
            tasks = [Task(case, number, transformers) for number in range(buses)]
            found = list(spread(follow_bus, tasks, f"{case.value}, {transformers.value}", pool))
            faults = sum(one.outcome.called_fault is not None for one in found)
            called, total = called + faults, total + len(found)
            others += sum(one.others_called for one in found)
            rows.append(
                [
                    transformers.value, case.value, rate_text(faults, len(found)),
                    *outcome_row([one.outcome for one in found]),
                    f"{sum(one.others_called for one in found)}",
                ]
            )  # fmt: skip
    yield from table(
        ["transformer", "first motor", "called `fault`", "seen", "in the end", "other motors called"], rows
    )
    yield ""
    yield f"{rate_text(called, total)} called `fault`: {mark(called <= MOST_CALLED * total)} "
    yield f"({MOST_CALLED:.0%}). Other motors called: {others}."
    yield ""
    yield from _growth(buses, pool)
    yield ""
    yield from _standing(buses, pool)


def _growth(buses: int, pool: Executor) -> Iterator[str]:
    rows = []
    for transformers in (Transformers.OWN, Transformers.COMMON):
        tasks = [Task(Case.GROWTH, number, transformers) for number in range(buses)]
        found = list(spread(follow_bus, tasks, "growth", pool))
        called = [one for one in found if one.outcome.called_fault is not None]
        delays = np.array([one.outcome.called_fault for one in called], dtype=np.float64)
        named = Counter(
            " or ".join(str(kind) for kind in one.outcome.final) or "none"
            for one in found
            if one.outcome.called_fault is None
        )
        rows.append(
            [
                transformers.value, rate_text(len(called), len(found)),
                f"{quantile_text(delays)}, {quantile_text(delays, 0.9)}",
                f"{sum(one.right for one in called)} of {len(called)}",
                ", ".join(f"{name} {count}" for name, count in named.most_common()) or "-",
            ]
        )  # fmt: skip
    yield f"Growth of 0.01 % of the turns a record, for {AFTER} records:"
    yield ""
    yield from table(
        ["transformer", "called `fault`", "by record: median, 90 %", "phase right", "others in the end"], rows
    )


def _standing(buses: int, pool: Executor) -> Iterator[str]:
    kinds = (
        ("five motors, own transformers", Task(Case.STANDING, 0)),
        ("five motors, a common one, stated", Task(Case.STANDING, 0, Transformers.COMMON)),
        ("five motors, a common one, not stated", Task(Case.STANDING, 0, Transformers.UNSTATED)),
        ("five motors, own transformers, 1 % and 50 us", Task(Case.STANDING, 0, sensors=COARSE)),
        ("alone, 1 % and 50 us", Task(Case.STANDING, 0, sensors=COARSE, motors=1)),
    )
    rows = []
    for name, task in kinds:
        for level in (0.0, *STANDING_LEVELS, *((0.03,) if task.motors == 1 else ())):
            tasks = [replace(task, number=number, level=level) for number in range(buses)]
            found = list(spread(follow_bus, tasks, f"standing {level:.2%}, {name}", pool))
            called = [one for one in found if one.outcome.called_fault is not None]
            watched = sum(one.outcome.final_state is State.WATCH for one in found)
            rows.append(
                [
                    name, f"{level:.2%}", rate_text(len(called), len(found)),
                    f"{sum(one.right for one in called)} of {len(called)}" if level else "-", f"{watched}",
                    f"{sum(one.others_called for one in found)}",
                ]
            )  # fmt: skip
    yield f"Faulty from the first record on, {STANDING_RECORDS} records, paths 0, 1 or 3:"
    yield ""
    yield from table(
        ["motors", "level", "called `fault`", "phase right", "`watch` in the end", "other motors called"],
        rows,
    )
