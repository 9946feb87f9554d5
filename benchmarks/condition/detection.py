"""Steps of the fault level: how soon they are seen and called, with which phase, and what intervals hold."""

from collections.abc import Generator, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from benchmarks.condition.courses import healthy, shape, with_fault
from benchmarks.condition.following import Outcome, Said, follow, judged_around, outcome, quantile_text
from benchmarks.condition.operation import draw_operation
from benchmarks.condition.population import SimulatedMotor, draw_motor
from benchmarks.condition.records import HARSH_NOISE, REAL_NOISE, measure
from benchmarks.reporting import mark, rate_text, spread, table
from core.condition.kinds import State

LEVELS = (0.003, 0.005, 0.0075, 0.01, 0.02)
PATHS = (0.0, 1.0, 3.0)
SHORT_REFERENCE = 20
REFERENCES = (60, 140)
SEEN_WITHIN, CALLED_WITHIN = 10, 100
SURE_LEVEL = 0.01
LEAST_SEEN = LEAST_CALLED = 0.97
LEAST_PHASE = 0.995
RAMP_RECORDS = 40
"""Within which a fault grows that then stays as it is."""
RAMP_LEVELS = (0.0075, 0.01, 0.02)
LEAST_HELD = 0.93
"""Of intervals of 95 %."""
HELD = ("true level within `mu_f_ci95`", "its change within `change_ci95`")
AT_THE_LIMIT = (0.005, 0.006)
"""Levels at the motor's limit and just above it."""
FOLLOWED = 300
"""Records with such a level."""


@dataclass(frozen=True, slots=True)
class Task:
    """One motor with a step, by its number; `references` is the range of the healthy records before it.

    constant_supply: V2/V1 does not wander, so that nothing tells the motor's impedance but its file.
    grows: records within which the level is reached; 0 of a step.
    """

    number: int
    level: float
    path_ratio: float
    noise: float
    references: tuple[int, int]
    constant_supply: bool = False
    grows: int = 0


@dataclass(frozen=True, slots=True)
class Result:
    """What came of a step, and whether the phase that was called is the true one.

    level_held, change_held: whether the intervals of the level and of its change hold the true one after the
    last record; a change without an interval is not held.
    """

    outcome: Outcome
    right: bool
    level_held: bool
    change_held: bool


def follow_step(task: Task) -> Result:
    """Simulate a motor with a step of the fault level and follow it for 100 records after it."""
    said, first, place = _followed(task, CALLED_WITHIN, closely=False)
    found = outcome(said, first)
    last = said[-1].condition
    return Result(
        found,
        found.phase == place,
        _holds(last.mu_f_ci95, task.level),
        _holds(last.change_ci95, task.level),
    )


def follow_at_the_limit(number: int) -> int:
    """How often a motor whose level lies at the limit turns from watch to fault or back in 300 records."""
    random = np.random.default_rng([number, 20])
    task = Task(number, random.uniform(*AT_THE_LIMIT), float(random.choice(PATHS)), REAL_NOISE, REFERENCES)
    said, first, _ = _followed(task, FOLLOWED, closely=True)
    states = [one.condition.state for one in said if one.record >= first]
    faulty = [state is State.FAULT for state in states]
    return sum(before is not after for before, after in pairwise(faulty))


def _followed(task: Task, records_after: int, *, closely: bool) -> tuple[list[Said], int, str]:
    """What is said of a motor, the first record with the fault, and its true phase."""
    random = np.random.default_rng([task.number, 2])
    simulated = draw_motor(random)
    first = int(random.integers(task.references[0], task.references[1] + 1))
    records = first + records_after
    operation = draw_operation(random, records)
    if task.constant_supply:
        operation = operation.on_constant_supply()
    winding = int(random.integers(3))
    level = task.level * shape(records, first, task.grows)
    course = with_fault(healthy(records), winding, level, task.path_ratio)
    observations = measure(random, simulated, operation, course, task.noise).observations()
    judged = range(first, records) if closely else judged_around(first, records)
    return list(follow(simulated.motor, observations, judged)), first, true_phase(simulated, winding)


def _holds(interval: tuple[float, float] | None, level: float) -> bool:
    return interval is not None and interval[0] <= level <= interval[1]


def true_phase(simulated: SimulatedMotor, winding: int) -> str:
    """Name of a winding of the machine's own frame at the terminals."""
    return "abc"[simulated.terminal(winding)]


def detection(motors: int, pool: Executor) -> Iterator[str]:
    """Tables of steps after a long and a short reference, and what they say of 1 %."""
    sure: list[Result] = []
    called: list[Result] = []
    short = (SHORT_REFERENCE, SHORT_REFERENCE)
    for references, constant in ((REFERENCES, False), (short, False), (REFERENCES, True)):
        rows = []
        for noise, name in ((REAL_NOISE, "real"), (HARSH_NOISE, "harsh")):
            for level in LEVELS:
                for path in PATHS:
                    tasks = [
                        Task(number, level, path, noise, references, constant) for number in range(motors)
                    ]
                    found = list(spread(follow_step, tasks, f"{name} {level:.2%} path {path:g}", pool))
                    rows.append([name, f"{level:.2%}", f"{path:g}", *_row(found)])
                    called += [one for one in found if one.outcome.called_fault is not None]
                    if level == SURE_LEVEL and name == "real" and references == REFERENCES and not constant:
                        sure += found
        yield f"After a reference of {' to '.join(f'{n}' for n in sorted(set(references)))} records"
        yield "on a supply whose V2/V1 is constant:" if constant else "on a supply that wanders and jumps:"
        yield ""
        yield from table(
            [
                "noise", "step", "path", f"seen within {SEEN_WITHIN}", "median delay, 90 %",
                f"`fault` within {CALLED_WITHIN}", "median delay, 90 %", "phase right", *HELD,
            ],
            rows,
        )  # fmt: skip
        yield ""
    stopped = yield from _growth_that_stops(motors, pool)
    yield ""
    seen = sum(_within(one.outcome.seen, SEEN_WITHIN) for one in sure)
    faults = sum(one.outcome.called_fault is not None for one in sure)
    right = sum(one.right for one in called)
    yield f"- {SURE_LEVEL:.0%}, real, seen within {SEEN_WITHIN} records: {rate_text(seen, len(sure))}: "
    yield f"  {mark(seen >= LEAST_SEEN * len(sure))} ({LEAST_SEEN:.0%})."
    yield f"- {SURE_LEVEL:.0%}, real, `fault` within {CALLED_WITHIN}: {rate_text(faults, len(sure))}: "
    yield f"  {mark(faults >= LEAST_CALLED * len(sure))} ({LEAST_CALLED:.0%})."
    yield f"- Phase right in all called, all cells: {rate_text(right, len(called))}: "
    yield f"  {mark(right >= LEAST_PHASE * len(called))} ({LEAST_PHASE:.1%})."
    yield from _held_of_all("steps", called)
    yield from _held_of_all("growth that stops", stopped)
    turns = list(spread(follow_at_the_limit, range(motors), "at the limit", pool))
    low, high = AT_THE_LIMIT
    yield f"- Steps to {low:.1%} to {high:.1%}, limit {low:.1%}, real, {FOLLOWED} records judged one by one:"
    yield f"  from `watch` to `fault` or back {sum(turns)} times in {len(turns)} motors, at most {max(turns)}"
    yield f"  times in one, more than once in {rate_text(sum(n > 1 for n in turns), len(turns))}."


def _growth_that_stops(motors: int, pool: Executor) -> Generator[str, None, list[Result]]:
    """A table of levels that are reached within 40 records and stay; return those called a fault."""
    rows, every = [], []
    for noise, name in ((REAL_NOISE, "real"), (HARSH_NOISE, "harsh")):
        for level in RAMP_LEVELS:
            for path in PATHS:
                tasks = [
                    Task(number, level, path, noise, REFERENCES, grows=RAMP_RECORDS)
                    for number in range(motors)
                ]
                found = list(spread(follow_step, tasks, f"{name} growth to {level:.2%} path {path:g}", pool))
                called = [one for one in found if one.outcome.called_fault is not None]
                right = sum(one.right for one in called)
                rows.append(
                    [
                        name, f"{level:.2%}", f"{path:g}", f"{len(called) / len(found):.3f}",
                        f"{right} of {len(called)}", *_held(called),
                    ]
                )  # fmt: skip
                every += called
    yield f"Growth that stops: the level is reached within {RAMP_RECORDS} records and stays:"
    yield ""
    yield from table(
        ["noise", "level", "path", f"`fault` within {CALLED_WITHIN}", "phase right", *HELD], rows
    )
    return every


def _held_of_all(name: str, called: list[Result]) -> Iterator[str]:
    for what, held in (
        (HELD[0], sum(one.level_held for one in called)),
        (HELD[1], sum(one.change_held for one in called)),
    ):
        yield f"- Of {name} called `fault`, {what}, {CALLED_WITHIN} records after the first with it:"
        enough = mark(held >= LEAST_HELD * len(called))
        yield f"  {rate_text(held, len(called))}: {enough} ({LEAST_HELD:.0%})."


def _row(found: list[Result]) -> list[str]:
    seen = np.array([one.outcome.seen for one in found if one.outcome.seen is not None], dtype=np.float64)
    called = [one for one in found if one.outcome.called_fault is not None]
    delays = np.array([one.outcome.called_fault for one in called], dtype=np.float64)
    return [
        f"{sum(_within(one.outcome.seen, SEEN_WITHIN) for one in found) / len(found):.3f}",
        f"{quantile_text(seen)}, {quantile_text(seen, 0.9)}",
        f"{len(called) / len(found):.3f}",
        f"{quantile_text(delays)}, {quantile_text(delays, 0.9)}",
        f"{sum(one.right for one in called)} of {len(called)}",
        *_held(called),
    ]


def _held(called: list[Result]) -> list[str]:
    return [
        f"{sum(one.level_held for one in called)} of {len(called)}",
        f"{sum(one.change_held for one in called)} of {len(called)}",
    ]


def _within(delay: int | None, records: int) -> bool:
    return delay is not None and delay < records
