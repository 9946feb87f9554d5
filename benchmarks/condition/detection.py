"""Steps of the fault level: how soon they are seen and called, with which phase, and what intervals hold."""

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise

import numpy as np

from benchmarks.condition.circuit import Array
from benchmarks.condition.courses import healthy, shape, with_fault
from benchmarks.condition.following import Outcome, Said, follow, judged_around, outcome, quantile_text
from benchmarks.condition.marks import Mark, at_least, median_at_most, percent, range_reached
from benchmarks.condition.operation import draw_operation
from benchmarks.condition.population import SimulatedMotor, draw_motor
from benchmarks.condition.records import HARSH_NOISE, REAL_NOISE, measure
from benchmarks.reporting import rate_text, spread, table
from core.condition.kinds import State

LEVELS = (0.003, 0.005, 0.0075, 0.01, 0.02)
PATHS = (0.0, 1.0, 3.0)
SHORT_REFERENCE = 20
REFERENCES = (60, 140)
SEEN_WITHIN, CALLED_WITHIN = 10, 100
SURE_LEVEL = 0.01
LEAST_SEEN = LEAST_CALLED = 0.97
LEAST_PHASE = 0.995
NOISES = ((REAL_NOISE, "real"), (HARSH_NOISE, "harsh"))
SEEN_FLOORS = {
    ("real", 0.003): (0.89, 0.90), ("real", 0.005): (0.94, 0.98), ("real", 0.01): (0.99, 1.0),
    ("real", 0.02): (1.0, 1.0), ("harsh", 0.003): (0.11, 0.46), ("harsh", 0.005): (0.70, 0.86),
    ("harsh", 0.01): (0.94, 1.0), ("harsh", 0.02): (1.0, 1.0),
}  # fmt: skip
CALLED_FLOORS = {
    ("real", 0.0075): (0.98, 1.0), ("real", 0.01): (0.99, 1.0), ("real", 0.02): (1.0, 1.0),
    ("harsh", 0.0075): (0.89, 0.97), ("harsh", 0.01): (0.94, 0.98), ("harsh", 0.02): (0.97, 1.0),
}  # fmt: skip
"""By noise and level: of the lowest and of the highest path."""
SHORT_FLOORS = {
    ("real", 0.005): 0.97, ("harsh", 0.005): 0.48, ("real", 0.01): 1.0, ("harsh", 0.01): 0.95,
}  # fmt: skip
MEDIAN_SEEN = 4.0
MEDIAN_CALLED = {0.0: 28.0, 1.0: 10.0, 3.0: 6.0}
"""Records until 1 % is called, by path."""
RAMP_RECORDS = 40
"""Within which a fault grows that then stays as it is."""
RAMP_LEVELS = (0.0075, 0.01, 0.02)
LEAST_HELD = 0.95
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


Found = dict[tuple[str, float, float], list[Result]]
"""Results by the noise's name, level and path."""


class Situation(StrEnum):
    """What a motor is known by before the step, and what its supply does."""

    LONG = "60 to 140 records on a supply that wanders and jumps"
    SHORT = "20 records on a supply that wanders and jumps"
    CONSTANT = "60 to 140 records on a supply whose V2/V1 is constant"

    @property
    def references(self) -> tuple[int, int]:
        return (SHORT_REFERENCE, SHORT_REFERENCE) if self is Situation.SHORT else REFERENCES

    @property
    def constant_supply(self) -> bool:
        return self is Situation.CONSTANT


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


def detection(motors: int, pool: Executor) -> Iterator[str | Mark]:
    """Marks, and tables of steps after a long and a short reference and of growth that stops."""
    every: dict[Situation, Found] = {}
    lines: list[str] = []
    for situation in Situation:
        every[situation] = found = _found_of(situation, motors, pool)
        lines += [f"After a reference of {situation}:", "", *_table(found), ""]
    stopped, growth = _growth_that_stops(motors, pool)
    yield from _floors(every[Situation.LONG])
    yield from _floors_of_a_short_reference(every[Situation.SHORT])
    for situation, found in every.items():
        yield from _sure(situation, found)
    called = [one for found in every.values() for cell in found.values() for one in _called(cell)]
    yield at_least(
        "phase right in all called, all steps", sum(one.right for one in called), len(called), LEAST_PHASE
    )
    yield from _held_of_all("steps", called)
    yield from _held_of_all("growth that stops", stopped)
    yield from lines
    yield from growth
    yield ""
    turns = list(spread(follow_at_the_limit, range(motors), "at the limit", pool))
    low, high = AT_THE_LIMIT
    yield f"Steps to {low:.1%} to {high:.1%}, limit {low:.1%}, real, {FOLLOWED} records judged one by one:"
    yield f"from `watch` to `fault` or back {sum(turns)} times in {len(turns)} motors, at most {max(turns)}"
    yield f"times in one, more than once in {rate_text(sum(n > 1 for n in turns), len(turns))}."


def _found_of(situation: Situation, motors: int, pool: Executor) -> Found:
    found: Found = {}
    for noise, name in NOISES:
        for level in LEVELS:
            for path in PATHS:
                tasks = [
                    Task(number, level, path, noise, situation.references, situation.constant_supply)
                    for number in range(motors)
                ]
                label = f"detection, {situation.name.lower()}, {name} {level:.2%} path {path:g}"
                found[name, level, path] = list(spread(follow_step, tasks, label, pool))
    return found


def _table(found: Found) -> list[str]:
    return table(
        [
            "noise", "step", "path", f"seen within {SEEN_WITHIN}", "median delay, 90 %",
            f"`fault` within {CALLED_WITHIN}", "median delay, 90 %", "phase right", *HELD,
        ],
        [[name, f"{level:.2%}", f"{path:g}", *_row(cell)] for (name, level, path), cell in found.items()],
    )  # fmt: skip


def _floors(found: Found) -> Iterator[Mark]:
    """What a study of the method reached after a long reference on a supply that wanders."""
    for what, floors, count in (
        (f"seen within {SEEN_WITHIN} records", SEEN_FLOORS, _seen),
        (f"`fault` within {CALLED_WITHIN} records", CALLED_FLOORS, lambda cell: len(_called(cell))),
    ):
        for (name, level), (low, high) in floors.items():
            cells = {f"path {path:g}": found[name, level, path] for path in PATHS}
            counts = {path: (count(cell), len(cell)) for path, cell in cells.items()}
            yield range_reached(f"step of {percent(level)}, {name}: {what}", counts, low, high)
    real = [one for (name, _, _), cell in found.items() if name == "real" for one in cell]
    delays = np.array([one.outcome.seen for one in real if one.outcome.seen is not None], dtype=np.float64)
    yield median_at_most("all steps, real: median delay until seen", delays, MEDIAN_SEEN)
    for path, most in MEDIAN_CALLED.items():
        cell = found["real", SURE_LEVEL, path]
        what = f"step of {percent(SURE_LEVEL)}, real, path {path:g}: median delay until `fault`"
        yield median_at_most(what, _delays(_called(cell)), most)
    called = [one for cell in found.values() for one in _called(cell)]
    right = sum(one.right for one in called)
    yield at_least(f"phase right in all called, after {Situation.LONG}", right, len(called), 1.0)


def _floors_of_a_short_reference(found: Found) -> Iterator[Mark]:
    for (name, level), least in SHORT_FLOORS.items():
        cells = [one for path in PATHS for one in found[name, level, path]]
        after = f"{name}, all paths, after {SHORT_REFERENCE} records"
        what = f"step of {percent(level)}, {after}: seen within {SEEN_WITHIN} records"
        yield at_least(what, _seen(cells), len(cells), least)


def _sure(situation: Situation, found: Found) -> Iterator[Mark]:
    cells = [one for path in PATHS for one in found["real", SURE_LEVEL, path]]
    what = f"step of {percent(SURE_LEVEL)}, real, all paths, after {situation}"
    yield at_least(f"{what}: seen within {SEEN_WITHIN}", _seen(cells), len(cells), LEAST_SEEN)
    yield at_least(f"{what}: `fault` within {CALLED_WITHIN}", len(_called(cells)), len(cells), LEAST_CALLED)


def _seen(cell: Sequence[Result]) -> int:
    return sum(_within(one.outcome.seen, SEEN_WITHIN) for one in cell)


def _called(cell: Sequence[Result]) -> list[Result]:
    return [one for one in cell if one.outcome.called_fault is not None]


def _delays(called: Sequence[Result]) -> Array:
    return np.array([one.outcome.called_fault for one in called], dtype=np.float64)


def _growth_that_stops(motors: int, pool: Executor) -> tuple[list[Result], list[str]]:
    """Of levels that are reached within 40 records and stay: those called a fault, and a table."""
    rows: list[list[str]] = []
    every: list[Result] = []
    for noise, name in NOISES:
        for level in RAMP_LEVELS:
            for path in PATHS:
                tasks = [
                    Task(number, level, path, noise, REFERENCES, grows=RAMP_RECORDS)
                    for number in range(motors)
                ]
                found = list(spread(follow_step, tasks, f"{name} growth to {level:.2%} path {path:g}", pool))
                called = _called(found)
                right = sum(one.right for one in called)
                rows.append(
                    [
                        name, f"{level:.2%}", f"{path:g}", f"{len(called) / len(found):.3f}",
                        f"{right} of {len(called)}", *_held(called),
                    ]
                )  # fmt: skip
                every += called
    header = ["noise", "level", "path", f"`fault` within {CALLED_WITHIN}", "phase right", *HELD]
    about = f"Growth that stops: the level is reached within {RAMP_RECORDS} records and stays:"
    return every, [about, "", *table(header, rows)]


def _held_of_all(name: str, called: Sequence[Result]) -> Iterator[Mark]:
    for what, held in (
        (HELD[0], sum(one.level_held for one in called)),
        (HELD[1], sum(one.change_held for one in called)),
    ):
        yield at_least(f"{name} called `fault`: {what}", held, len(called), LEAST_HELD)


def _row(found: list[Result]) -> list[str]:
    seen = np.array([one.outcome.seen for one in found if one.outcome.seen is not None], dtype=np.float64)
    called = _called(found)
    delays = _delays(called)
    return [
        f"{_seen(found) / len(found):.3f}",
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
