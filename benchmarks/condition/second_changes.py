"""A second change after a first one was named: whether it is seen, and whether a fault stays one."""

from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from benchmarks.condition.courses import (
    Course,
    healthy,
    shape,
    with_current_error,
    with_fault,
    with_joint,
    with_voltage_error,
)
from benchmarks.condition.disturbances import JOINT_DROPS
from benchmarks.condition.following import Said, follow, quantile_text
from benchmarks.condition.operation import draw_operation
from benchmarks.condition.population import SimulatedMotor, draw_motor
from benchmarks.condition.records import HARSH_NOISE, REAL_NOISE, measure
from benchmarks.reporting import rate_text, spread, table
from core.condition.kinds import State

BEFORE = (60, 140)
BETWEEN = 100
AFTER = 100
CHANNEL_ERRORS = (0.01, 0.02)
LEVEL = 0.015
FIRST_LEVEL, MORE = 0.01, 2.0


class Second(StrEnum):
    """What comes first, and what second."""

    AFTER_VOLTAGE = "voltage channel, then shorted turns"
    AFTER_CURRENT = "current channel, then shorted turns"
    AFTER_JOINT = "joint, then shorted turns"
    MORE_TURNS = "shorted turns, then twice as many"
    VOLTAGE_AFTER = "shorted turns, then a voltage channel"
    CURRENT_AFTER = "shorted turns, then a current channel"


@dataclass(frozen=True, slots=True)
class Task:
    """One motor with two changes, by its number."""

    second: Second
    number: int
    noise: float


@dataclass(frozen=True, slots=True)
class Result:
    """What came of the second change.

    called: records until the state was `fault` with the right phase, None where it never was.  kept: share of
    the later records in which it stayed so.  level: told at the end over the true one; None where it was no
    fault then.
    """

    called: int | None
    kept: float
    level: float | None


def changed_twice(
    second: Second, random: np.random.Generator, simulated: SimulatedMotor, first: int, winding: int
) -> Course:
    """A course with both changes, the second one 100 records after the first."""
    records = first + BETWEEN + AFTER
    begun, later = shape(records, first), shape(records, first + BETWEEN)
    course = healthy(records)
    place, path = int(random.integers(3)), float(random.uniform(0.0, 3.0))
    error = complex(random.uniform(*CHANNEL_ERRORS) * random.choice([-1.0, 1.0]))
    joint_ohm = random.uniform(*JOINT_DROPS) * simulated.rated_line_impedance_ohm
    match second:
        case Second.AFTER_VOLTAGE:
            return with_fault(with_voltage_error(course, place, error, begun), winding, LEVEL * later, path)
        case Second.AFTER_CURRENT:
            return with_fault(with_current_error(course, place, error, begun), winding, LEVEL * later, path)
        case Second.AFTER_JOINT:
            return with_fault(with_joint(course, place, joint_ohm, begun), winding, LEVEL * later, path)
        case Second.MORE_TURNS:
            return with_fault(course, winding, FIRST_LEVEL * (begun + (MORE - 1.0) * later), path)
        case Second.VOLTAGE_AFTER:
            course = with_fault(course, winding, FIRST_LEVEL * begun, path)
            return with_voltage_error(course, place, error, later)
        case Second.CURRENT_AFTER:
            course = with_fault(course, winding, FIRST_LEVEL * begun, path)
            return with_current_error(course, place, error, later)


def follow_both(task: Task) -> Result:
    """Simulate a motor with two changes and follow it for 100 records after the second."""
    random = np.random.default_rng([task.number, 6, list(Second).index(task.second)])
    simulated = draw_motor(random)
    first = int(random.integers(BEFORE[0], BEFORE[1] + 1))
    at = first + BETWEEN
    operation = draw_operation(random, at + AFTER)
    winding = int(random.integers(3))
    course = changed_twice(task.second, random, simulated, first, winding)
    observations = measure(random, simulated, operation, course, task.noise).observations()
    phase = "abc"[simulated.terminal(winding)]
    said = list(follow(simulated.motor, observations, range(at, at + AFTER)))
    right = [_is_fault(one) and one.condition.phase == phase for one in said]
    called = right.index(True) if any(right) else None
    level = said[-1].condition.mu_f if right[-1] else None
    return Result(
        called=called,
        kept=0.0 if called is None else float(np.mean(right[called:])),
        level=None if level is None else level / float(course.level[-1]),
    )


def second_changes(motors: int, pool: Executor) -> Iterator[str]:
    """A table of what comes of the second change."""
    rows = []
    for noise, name in ((REAL_NOISE, "real"), (HARSH_NOISE, "harsh")):
        for second in Second:
            tasks = [Task(second, number, noise) for number in range(motors)]
            found = list(spread(follow_both, tasks, f"{name}, {second.value}", pool))
            rows.append([name, second.value, *_row(found)])
    yield from table(
        [
            "noise",
            "what",
            "`fault`, phase right",
            "median delay, 90 %",
            "kept",
            "level told / true, 10-50-90 %",
        ],
        rows,
    )


def _row(found: list[Result]) -> list[str]:
    delays = np.array([one.called for one in found if one.called is not None], dtype=np.float64)
    kept = [one.kept for one in found if one.called is not None]
    levels = np.array([one.level for one in found if one.level is not None])
    quantiles = np.quantile(levels, [0.1, 0.5, 0.9]) if levels.size else []
    return [
        rate_text(len(delays), len(found)),
        f"{quantile_text(delays)}, {quantile_text(delays, 0.9)}",
        f"{np.mean(kept):.3f}" if kept else "-",
        ", ".join(f"{one:.2f}" for one in quantiles) or "-",
    ]


def _is_fault(said: Said) -> bool:
    return said.condition.state is State.FAULT
