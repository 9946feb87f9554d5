"""Five motors on one bus: channels judged against each other, and motors faulty from the beginning."""

from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from benchmarks.condition.courses import Course, healthy, shape, with_fault, with_unbalance
from benchmarks.condition.disturbances import Disturbance, disturbed, outcome_row
from benchmarks.condition.following import (
    Outcome,
    follow_together,
    judged_around,
    outcome,
    quantile_text,
)
from benchmarks.condition.marks import Mark, at_least, at_most, median_at_most, percent
from benchmarks.condition.operation import Operation, draw_operation
from benchmarks.condition.population import SENSOR_CLASSES, SimulatedMotor, draw_motor, draw_site
from benchmarks.condition.records import REAL_NOISE, measure
from benchmarks.reporting import rate_text, spread, table
from core.condition.kinds import Kind, State
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
"""Of each disturbance."""
MEDIAN_GROWTH = 59.0
LEAST_PHASE = 0.995


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
    """What came of the first motor, its level if it stands, whether its phase is right, how many others there
    are and how many of them were called a fault."""

    outcome: Outcome
    level: float
    right: bool
    others: int
    others_called: int


Part = tuple[list[Result], list[Mark], list[str]]
"""A part of the section: all results, its marks, the lines of its table."""


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
    said, others = follow_together(
        [one.motor for one in motors],
        every,
        judged_around(first, records),
        compared=task.transformers is not Transformers.COMMON,
    )
    others_called = sum(one.condition.state is State.FAULT for one in others)
    found = outcome(said, first)
    place = "abc"[motors[0].terminal(winding)]
    return Result(found, task.level, found.phase == place, task.motors - 1, others_called)


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


def bus(buses: int, pool: Executor) -> Iterator[str | Mark]:
    """Marks and tables of what comes to a bus, and of motors that are faulty from the first record on."""
    others: list[Result] = []
    lines: list[str] = []
    for part in (_disturbances, _growth, _standing):
        found, marks, said = part(buses, pool)
        others += found
        lines += [*said, ""]
        yield from marks
    number = sum(one.others for one in others)
    yield at_most("other motors of all buses called `fault`", _others_called(others), number, 0.0)
    yield from lines


def _disturbances(buses: int, pool: Executor) -> Part:
    """What comes to a bus: all results, marks, a table."""
    rows: list[list[str]] = []
    marks: list[Mark] = []
    every: list[Result] = []
    for transformers in (Transformers.OWN, Transformers.COMMON):
        by_case: dict[Case, list[Result]] = {}
        for case in (*DISTURBANCES, Case.SUPPLY):
            tasks = [Task(case, number, transformers) for number in range(buses)]
            found = list(spread(follow_bus, tasks, f"{case.value}, {transformers.value}", pool))
            by_case[case] = found
            rows.append(
                [
                    transformers.value, case.value, rate_text(len(_called(found)), len(found)),
                    *outcome_row([one.outcome for one in found]), f"{_others_called(found)}",
                ]
            )  # fmt: skip
            if transformers is Transformers.OWN and case in (Case.VOLTAGE_STEP, Case.VOLTAGE_DRIFT):
                named = sum(one.outcome.final == (Kind.VOLTAGE_CHANNEL,) for one in found)
                marks.append(at_least(f"{case.value}, own transformers: named so", named, len(found), 1.0))
            every += found
        worst = max(by_case, key=lambda case: len(_called(by_case[case])))
        called = len(_called(by_case[worst]))
        kind = f"{worst.value}, the worst" if called else "any disturbance"
        what = f"{kind}, transformers {transformers.value}: called `fault`"
        marks.append(at_most(what, called, len(by_case[worst]), MOST_CALLED))
    header = ["transformers", "first motor", "called `fault`", "seen", "in the end", "other motors called"]
    return every, marks, table(header, rows)


def _growth(buses: int, pool: Executor) -> Part:
    """Shorted turns that grow: all results, marks, a table."""
    rows: list[list[str]] = []
    marks: list[Mark] = []
    every: list[Result] = []
    for transformers in (Transformers.OWN, Transformers.COMMON):
        tasks = [Task(Case.GROWTH, number, transformers) for number in range(buses)]
        found = list(spread(follow_bus, tasks, f"growth, {transformers.value}", pool))
        every += found
        called = _called(found)
        right = sum(one.right for one in called)
        delays = np.array([one.outcome.called_fault for one in called], dtype=np.float64)
        named = Counter(
            " or ".join(str(kind) for kind in one.outcome.final) or "none"
            for one in found
            if one.outcome.called_fault is None
        )
        rows.append(
            [
                transformers.value, rate_text(len(called), len(found)),
                f"{quantile_text(delays)}, {quantile_text(delays, 0.9)}", f"{right} of {len(called)}",
                ", ".join(f"{name} {count}" for name, count in named.most_common()) or "-",
            ]
        )  # fmt: skip
        if transformers is Transformers.OWN:
            what = "growth of 0.01 % a record, own transformers"
            marks += [
                at_least(f"{what}: called `fault`", len(called), len(found), 1.0),
                median_at_most(f"{what}: median delay until `fault`", delays, MEDIAN_GROWTH),
                at_least(f"{what}: phase right in all called", right, len(called), LEAST_PHASE),
            ]
    header = ["transformers", "called `fault`", "by record: median, 90 %", "phase right", "others in the end"]
    about = f"Growth of 0.01 % of the turns a record, for {AFTER} records:"
    return every, marks, [about, "", *table(header, rows)]


def _standing(buses: int, pool: Executor) -> Part:
    """Motors that are faulty from the first record on: all results, marks, a table."""
    own, alone = "five motors, own transformers", "alone, 1 % and 50 us"
    kinds = (
        (own, Task(Case.STANDING, 0)),
        ("five motors, a common one, stated", Task(Case.STANDING, 0, Transformers.COMMON)),
        ("five motors, a common one, not stated", Task(Case.STANDING, 0, Transformers.UNSTATED)),
        ("five motors, own transformers, 1 % and 50 us", Task(Case.STANDING, 0, sensors=COARSE)),
        (alone, Task(Case.STANDING, 0, sensors=COARSE, motors=1)),
    )
    floors = {(own, 0.0075): 0.90, (own, 0.01): 1.0, (alone, 0.03): 0.63}
    rows: list[list[str]] = []
    marks: list[Mark] = []
    every: list[Result] = []
    for name, task in kinds:
        for level in (0.0, *STANDING_LEVELS, *((0.03,) if task.motors == 1 else ())):
            tasks = [replace(task, number=number, level=level) for number in range(buses)]
            found = list(spread(follow_bus, tasks, f"standing {level:.2%}, {name}", pool))
            every += found
            called = _called(found)
            watched = sum(one.outcome.final_state is State.WATCH for one in found)
            rows.append(
                [
                    name, f"{level:.2%}", rate_text(len(called), len(found)),
                    f"{sum(one.right for one in called)} of {len(called)}" if level else "-", f"{watched}",
                    f"{_others_called(found)}",
                ]
            )  # fmt: skip
            if (name, level) in floors:
                what = f"{percent(level)} from the first record on, {name}: called `fault`"
                marks.append(at_least(what, len(called), len(found), floors[name, level]))
    faulty = [one for one in every if one.level and one.outcome.called_fault is not None]
    right = sum(one.right for one in faulty)
    marks.append(at_least("faulty from the first record on: phase right", right, len(faulty), LEAST_PHASE))
    sound = [one for one in every if not one.level]
    what = "sound from the first record on: called `fault`"
    marks.append(at_most(what, len(_called(sound)), len(sound), 0.0))
    header = ["motors", "level", "called `fault`", "phase right", "`watch` in the end", "other motors called"]
    about = f"Faulty from the first record on, {STANDING_RECORDS} records, paths 0, 1 or 3:"
    return every, marks, [about, "", *table(header, rows)]


def _called(found: Sequence[Result]) -> list[Result]:
    return [one for one in found if one.outcome.called_fault is not None]


def _others_called(found: Sequence[Result]) -> int:
    return sum(one.others_called for one in found)
