"""Steps of the fault level: how soon they are seen and called, and whether the phase is right."""

from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np

from benchmarks.condition.courses import healthy, shape, with_fault
from benchmarks.condition.following import Outcome, follow, judged_around, outcome, quantile_text
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


@dataclass(frozen=True, slots=True)
class Task:
    """One motor with a step, by its number; `references` is the range of the healthy records before it.

    constant_supply: V2/V1 does not wander, so that nothing tells the motor's impedance but its file.
    """

    number: int
    level: float
    path_ratio: float
    noise: float
    references: tuple[int, int]
    constant_supply: bool = False


@dataclass(frozen=True, slots=True)
class Result:
    """What came of a step, and whether the phase that was called is the true one."""

    outcome: Outcome
    right: bool


def follow_step(task: Task) -> Result:
    """Simulate a motor with a step of the fault level and follow it for 100 records after it."""
    random = np.random.default_rng([task.number, 2])
    simulated = draw_motor(random)
    first = int(random.integers(task.references[0], task.references[1] + 1))
    records = first + CALLED_WITHIN
    operation = draw_operation(random, records)
    if task.constant_supply:
        operation = operation.on_constant_supply()
    winding = int(random.integers(3))
    course = with_fault(healthy(records), winding, task.level * shape(records, first), task.path_ratio)
    observations = measure(random, simulated, operation, course, task.noise).observations()
    said = []
    for one in follow(simulated.motor, observations, judged_around(first, records)):
        said.append(one)
        if one.record >= first and one.condition.state is State.FAULT:
            break
    found = outcome(said, first)
    return Result(found, found.phase == true_phase(simulated, winding))


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
                f"`fault` within {CALLED_WITHIN}", "median delay, 90 %", "phase right",
            ],
            rows,
        )  # fmt: skip
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
    ]


def _within(delay: int | None, records: int) -> bool:
    return delay is not None and delay < records
