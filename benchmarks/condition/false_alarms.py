"""Healthy motors over months: alarms, the greatest statistic, and days in which a motor needs a look."""

from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np

from benchmarks.condition.courses import healthy
from benchmarks.condition.following import follow
from benchmarks.condition.marks import Mark, at_most, below
from benchmarks.condition.operation import HOUR_NS, Times, draw_kind_of_times, draw_operation
from benchmarks.condition.population import draw_motor
from benchmarks.condition.records import HARSH_NOISE, REAL_NOISE, measure, with_outliers
from benchmarks.reporting import rate_text, spread, table
from core.condition.kinds import State

DAY_NS = 24 * HOUR_NS
MOST_WATCHED = 0.01
LEAST_RECORDS = 1_000_000
OUTLIERS = 0.001
"""Share of records that are ten times as noisy, where there are any."""


@dataclass(frozen=True, slots=True)
class Population:
    """Healthy motors of one kind."""

    name: str
    noise: float
    parameter_span: float
    times: Times | None = Times.HOURLY
    outliers: float = 0.0


POPULATIONS = (
    Population("real, parameters within 10 %", REAL_NOISE, 0.10),
    Population("real, parameters within 25 %", REAL_NOISE, 0.25),
    Population("harsh, parameters within 10 %", HARSH_NOISE, 0.10),
    Population("harsh, parameters within 25 %", HARSH_NOISE, 0.25),
    Population("real, hourly, daily or irregular", REAL_NOISE, 0.10, times=None),
    Population("real, one record in 1,000 ten times as noisy", REAL_NOISE, 0.10, outliers=OUTLIERS),
)


@dataclass(frozen=True, slots=True)
class Task:
    """One motor of a population, by its number."""

    population: Population
    number: int
    records: int


@dataclass(frozen=True, slots=True)
class Result:
    """What came of a healthy motor.

    days, watched: motor-days with records after the reference, and those in which it was not healthy.
    standing: whether it was in doubt from the first record on, at its last.
    """

    records: int
    years: float
    alarmed: bool
    called_fault: bool
    greatest: float
    days: int
    watched: int
    standing: bool


def follow_healthy(task: Task) -> Result:
    """Simulate a motor and follow it."""
    population = task.population
    random = np.random.default_rng([task.number, 1, POPULATIONS.index(population)])
    simulated = draw_motor(random, parameter_span=population.parameter_span)
    times = population.times or draw_kind_of_times(random)
    operation = draw_operation(random, task.records, times=times)
    measured = measure(random, simulated, operation, healthy(task.records), population.noise)
    if population.outliers:
        measured = with_outliers(random, measured, population.outliers)
    greatest, alarmed, called = -np.inf, False, False
    days: dict[int, bool] = {}
    for said in follow(simulated.motor, measured.observations()):
        condition = said.condition
        greatest = max(greatest, said.statistic)
        alarmed |= said.changed
        called |= condition.state is State.FAULT
        if (
            condition.reference is not None
            and condition.reference.complete
            and condition.as_of_ns is not None
        ):
            day = condition.as_of_ns // DAY_NS
            days[day] = days.get(day, False) or condition.state is not State.HEALTHY
    elapsed_ns = float(operation.time_ns[-1] - operation.time_ns[0])
    return Result(
        records=task.records,
        years=elapsed_ns / (8_766.0 * HOUR_NS),
        alarmed=alarmed,
        called_fault=called,
        greatest=float(greatest),
        days=len(days),
        watched=sum(days.values()),
        standing=condition.state is State.WATCH and not said.changed,
    )


def false_alarms(motors: int, records: int, pool: Executor) -> Iterator[str | Mark]:
    """Marks of the whole, and a table of the populations."""
    rows: list[list[str]] = []
    every: list[Result] = []
    for population in POPULATIONS:
        tasks = [Task(population, number, records) for number in range(motors)]
        found = list(spread(follow_healthy, tasks, population.name, pool))
        every += found
        rows.append([population.name, *_row(found)])
    rows.append(["**all**", *_row(every)])
    alarms = sum(one.alarmed or one.called_fault for one in every)
    number = sum(one.records for one in every)
    yield at_most(f"healthy motors with an alarm, in {number:,} records", alarms, len(every), 0.0)
    enough = number >= LEAST_RECORDS
    yield Mark("records of healthy motors", f"at least {LEAST_RECORDS:,}", f"{number:,}", enough)
    watched, days = sum(one.watched for one in every), sum(one.days for one in every)
    yield below("motor-days of healthy motors in `watch`, after the reference", watched, days, MOST_WATCHED)
    yield from table(
        [
            "noise, file", "motors", "records", "motor-years", "motors with an alarm", "called `fault`",
            "greatest statistic", "motor-days in `watch`", "motors in `watch` at the end",
        ],
        rows,
    )  # fmt: skip


def _row(found: list[Result]) -> list[str]:
    days, watched = sum(one.days for one in found), sum(one.watched for one in found)
    return [
        f"{len(found)}",
        f"{sum(one.records for one in found):,}",
        f"{sum(one.years for one in found):,.0f}",
        rate_text(sum(one.alarmed for one in found), len(found)),
        f"{sum(one.called_fault for one in found)}",
        f"{max(one.greatest for one in found):.1f}",
        f"{watched} of {days:,} ({watched / max(days, 1):.2%})",
        f"{sum(one.standing for one in found)}",
    ]
