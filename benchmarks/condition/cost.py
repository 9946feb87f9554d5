"""What following costs: time a record, bytes a motor, and a plant of 500 motors refolded after ten years."""

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from time import perf_counter, process_time

import numpy as np

from benchmarks.condition.courses import healthy, shape, with_fault
from benchmarks.condition.marks import Mark, figure_at_most
from benchmarks.condition.operation import draw_operation
from benchmarks.condition.population import draw_motor
from benchmarks.condition.records import REAL_NOISE, measure
from benchmarks.reporting import spread, table
from core.condition.following.follower import Follower
from core.condition.observation import Observation
from core.condition.verdict.judging import condition_of

PLANT_MOTORS, PLANT_RECORDS = 500, 87_660
MOST_MICROSECONDS, MOST_KILOBYTES = 100.0, 50.0
STUDY_MICROSECONDS, STUDY_KILOBYTES = 52.0, 35.0
"""Of a study of the method, on another machine."""
MOST_GROWTH = 1.2
"""Of the time a record: it is not to depend on the number of records before."""
SAVED = 200
"""Saves that are timed."""


@dataclass(frozen=True, slots=True)
class Task:
    """One motor, by its number; faulty: with shorted turns from the middle on."""

    number: int
    records: int
    faulty: bool


@dataclass(frozen=True, slots=True)
class Cost:
    """Processor time a record [us]: all, the first and the last tenth; that of an assessment with its
    condition, after each record of the last tenth, and of a save; size of the state [kB]."""

    record_us: float
    first_us: float
    last_us: float
    assessment_us: float
    save_us: float
    state_kB: float


def measure_cost(task: Task) -> Cost:
    """Fold one motor's records."""
    random = np.random.default_rng([task.number, 6])
    simulated = draw_motor(random)
    operation = draw_operation(random, task.records)
    course = healthy(task.records)
    if task.faulty:
        course = with_fault(course, 0, 0.01 * shape(task.records, task.records // 2), 0.0)
    observations = measure(random, simulated, operation, course, REAL_NOISE).observations()
    follower = Follower(simulated.motor)
    tenth = max(1, task.records // 10)
    spent = []
    state = b""
    for part in (observations[:tenth], observations[tenth:-tenth], observations[-tenth:]):
        state = follower.save()
        begun = process_time()
        for observation in part:
            follower.fold(observation)
        spent.append(process_time() - begun)
    for _ in range(2):  # the first time, compiled functions are loaded
        assessed = _assessed(Follower.restore(simulated.motor, state), observations[-tenth:])
    begun = process_time()
    for _ in range(SAVED):
        state = follower.save()
    saved = process_time() - begun
    return Cost(
        record_us=sum(spent) / task.records * 1e6,
        first_us=spent[0] / tenth * 1e6,
        last_us=spent[2] / tenth * 1e6,
        assessment_us=assessed / tenth * 1e6,
        save_us=saved / SAVED * 1e6,
        state_kB=len(state) / 1e3,
    )


def _assessed(follower: Follower, observations: Sequence[Observation]) -> float:
    """Fold records with an assessment after each; return the processor time of the assessments [s]."""
    total = 0.0
    for observation in observations:
        follower.fold(observation)
        begun = process_time()
        assessment = follower.assessment()
        if assessment is None:
            raise ValueError("no assessment after a record")
        condition_of(follower.motor, assessment, assessment.as_of_ns)
        total += process_time() - begun
    return total


def cost(motors: int, records: int, long: int, pool: Executor) -> Iterator[str | Mark]:
    """Marks, tables of both kinds of motors, of ten years of one, and the time of the plant."""
    list(pool.map(measure_cost, [Task(0, 40, faulty=True)] * 4))  # compiles, if anything is to be compiled
    rows, every = [], []
    begun = perf_counter()
    folded = 0
    for name, faulty, count, each in (
        ("healthy", False, motors, records),
        ("1 % from the middle on", True, motors, records),
        ("healthy, ten years", False, 1, long),
    ):
        tasks = [Task(number, each, faulty) for number in range(count)]
        found = list(spread(measure_cost, tasks, f"cost, {name}", pool))
        every += found
        folded += count * each
        rows.append(
            [
                name, f"{count}", f"{each:,}", _mean(found, "record_us"), _mean(found, "first_us"),
                _mean(found, "last_us"), _mean(found, "assessment_us"), _mean(found, "save_us"),
                f"{max(one.state_kB for one in found):.1f}",
            ]
        )  # fmt: skip
    elapsed = perf_counter() - begun
    us = float(np.mean([one.record_us for one in every]))
    kB = max(one.state_kB for one in every)
    for beside, most_us, most_kB in (
        ("", MOST_MICROSECONDS, MOST_KILOBYTES),
        (", beside the study's", STUDY_MICROSECONDS, STUDY_KILOBYTES),
    ):
        yield figure_at_most(f"processor time a record{beside}", us, most_us, "us")
        yield figure_at_most(f"largest state of a motor{beside}", kB, most_kB, "kB")
    grown = every[-1].last_us / every[-1].first_us
    yield figure_at_most(
        "a record at the end of ten years over one at their beginning", grown, MOST_GROWTH, "times"
    )
    yield from table(
        [
            "motors", "number", "records each", "us a record", "first tenth", "last tenth",
            "assessment and condition, us", "save, us", "state, kB at most",
        ],
        rows,
    )  # fmt: skip
    yield ""
    hours = PLANT_MOTORS * PLANT_RECORDS * us * 1e-6 / 2 / 3_600
    yield f"{PLANT_MOTORS} motors with ten years of hourly records ({PLANT_MOTORS * PLANT_RECORDS:,}), on two"
    yield f"cores: {hours * 60:.0f} minutes, **extrapolated** from {folded:,} records, which took"
    yield f"{elapsed:.0f} s with their simulation. Reading them from a database is not in it."


def _mean(found: list[Cost], name: str) -> str:
    return f"{np.mean([getattr(one, name) for one in found]):.0f}"
