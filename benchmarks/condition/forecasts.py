"""Growing faults: how often the published interval holds the time to the limit."""

from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from enum import StrEnum
from math import inf, log

import numpy as np

from benchmarks.condition.circuit import Array
from benchmarks.condition.courses import healthy, shape, with_fault
from benchmarks.condition.following import follow
from benchmarks.condition.marks import Mark, at_least
from benchmarks.condition.operation import draw_operation
from benchmarks.condition.population import draw_motor
from benchmarks.condition.records import HARSH_NOISE, REAL_NOISE, measure
from benchmarks.reporting import rate_text, spread, table
from core.condition.forecast.outcome import HORIZONS_DAYS, Forecast

FIRST = 1000
"""Number of the first motor: chances were calibrated with motors 0 to 119, and are measured with others."""
REFERENCE = 100
LONGEST = 500
HIGHEST_LEVEL = 0.04
LOOKS = 4
"""Forecasts that are looked at of each motor."""
APART = 5
"""Records between forecasts."""
PATHS = (0.0, 1.0, 3.0)


class Growth(StrEnum):
    """How a level grows."""

    LINEAR = "linear"
    WANDERING = "wandering"
    EXPONENTIAL = "exponential"
    NONE = "none: a step that stays"


COVERAGE = 0.8
"""Of what is published as an interval of 80 %."""
TOLD = (0.5, 0.8, 0.9, 0.95)
"""Probabilities with which the level is told to stay below its limit until a day."""
NEAR = 0.1
"""What is told to hold with 80 % is to hold so often within this, or more often."""
LEAST_HELD = {Growth.LINEAR: 0.96, Growth.WANDERING: 0.83, Growth.EXPONENTIAL: 0.72}
"""The low ends of what a study of the method reached."""


@dataclass(frozen=True, slots=True)
class Task:
    """One motor with a fault that grows, by its number."""

    growth: Growth
    number: int
    noise: float


@dataclass(frozen=True, slots=True)
class Look:
    """One forecast [days], None for no trend, and the true time until the level reaches its limit [days].

    until: days until which the level is told to stay below its limit, by the probability; None where that is
    beyond the forecast.
    """

    days: tuple[float, float, float] | None
    true_days: float
    until: tuple[float | None, ...]


def levels_of(growth: Growth, random: np.random.Generator, records: int) -> Array:
    """Level after so many records of growth, without end."""
    since = np.arange(1.0, records + 1.0)
    rate = np.exp(random.uniform(log(2e-5), log(2e-4)))
    if growth is Growth.LINEAR:
        return np.asarray(rate * since)
    if growth is Growth.WANDERING:
        memory = random.uniform(20.0, 100.0)
        wander = np.empty(records)
        value = 0.7 * random.standard_normal()
        for k, step in enumerate(random.standard_normal(records)):
            value = np.exp(-1.0 / memory) * value + 0.7 * np.sqrt(1.0 - np.exp(-2.0 / memory)) * step
            wander[k] = value
        return np.asarray(np.cumsum(rate * np.exp(wander)))
    if growth is Growth.EXPONENTIAL:
        return np.asarray(random.uniform(5e-4, 2e-3) * np.expm1(since / random.uniform(25.0, 100.0)))
    return np.full(records, random.uniform(0.0075, 0.0125))


def follow_growth(task: Task) -> list[Look]:
    """Simulate a motor, follow it, and look at some of its forecasts."""
    random = np.random.default_rng([task.number, 5, list(Growth).index(task.growth)])
    simulated = draw_motor(random)
    endless = levels_of(task.growth, random, 20 * LONGEST)
    longest = min(LONGEST, int(np.searchsorted(endless, HIGHEST_LEVEL)))
    records = REFERENCE + longest
    operation = draw_operation(random, records)
    level = np.concatenate([np.zeros(REFERENCE), endless[:longest]]) * shape(records, REFERENCE)
    course = with_fault(healthy(records), int(random.integers(3)), level, float(random.choice(PATHS)))
    observations = measure(random, simulated, operation, course, task.noise).observations()
    looks = []
    for said in follow(simulated.motor, observations, range(REFERENCE, records, APART)):
        k, forecast = said.record, said.condition.forecast
        if not said.changed or forecast.growth_per_day is None:
            continue
        # Times are taken from the first record of the growth, and go on hourly after the last.
        crossing = REFERENCE + int(np.searchsorted(endless, forecast.limit))
        never = crossing >= REFERENCE + endless.size
        until = tuple(_until(forecast, probability) for probability in TOLD)
        looks.append(Look(forecast.days, inf if never else (crossing - k) / 24.0, until))
    ahead = [one for one in looks if one.true_days > 0.0]
    chosen = random.permutation(len(ahead))[:LOOKS]
    return [ahead[k] for k in chosen]


def _until(forecast: Forecast, probability: float) -> float | None:
    """Until when the level is told to stay below its limit with a probability [days]."""
    chances = forecast.chances
    if chances is None or chances[-1] < 1.0 - probability:
        return None
    return float(np.interp(1.0 - probability, chances, HORIZONS_DAYS))


def forecasts(motors: int, pool: Executor) -> Iterator[str | Mark]:
    """Marks, and a table of the growths."""
    rows: list[list[str]] = []
    told_rows: list[list[str]] = []
    for noise, name in ((REAL_NOISE, "real"), (HARSH_NOISE, "harsh")):
        growing: list[Look] = []
        for growth in Growth:
            tasks = [Task(growth, FIRST + number, noise) for number in range(motors)]
            looks = [
                one for found in spread(follow_growth, tasks, f"{name}, {growth}", pool) for one in found
            ]
            rows.append([name, growth.value, *_row(looks)])
            told_rows.append([name, growth.value, *(rate_text(*stayed(looks, one)) for one in TOLD)])
            if growth is Growth.NONE:
                silent = sum(one.days is None for one in looks)
                yield at_least(f"{growth.value}, {name}: no trend told", silent, len(looks), 1.0)
            else:
                growing += looks
                held, told = _held(looks)
                what = f"{growth.value}, {name}: interval holds the time"
                yield at_least(what, held, told, LEAST_HELD[growth])
        yield at_least(f"all growth, {name}: interval of 80 % holds the time", *_held(growing), COVERAGE)
        what = f"all growth, {name}: below its limit as long as told with 80 %"
        yield at_least(what, *stayed(growing, 0.8), 0.8 - NEAR)
    yield from table(
        [
            "noise", "growth", "forecasts", "no trend told", "interval holds the time", "too early",
            "too late", "last over first day, median",
        ],
        rows,
    )  # fmt: skip
    yield ""
    yield from table(["noise", "growth", *(f"told with {one:.0%}: held" for one in TOLD)], told_rows)


def stayed(looks: list[Look], probability: float) -> tuple[int, int]:
    """How many levels stayed below their limit as long as they were told to, of how many that were told."""
    place = TOLD.index(probability)
    told = [(one.until[place], one.true_days) for one in looks]
    known = [(until, true) for until, true in told if until is not None]
    return sum(true > until for until, true in known), len(known)


def _held(looks: list[Look]) -> tuple[int, int]:
    """How many intervals hold the time, of how many that are told."""
    told = [(one.days, one.true_days) for one in looks if one.days is not None]
    return sum(days[0] <= true <= days[2] for days, true in told), len(told)


def _row(looks: list[Look]) -> list[str]:
    told = [(one.days, one.true_days) for one in looks if one.days is not None]
    early = sum(days[2] < true for days, true in told)
    late = sum(true < days[0] for days, true in told)
    widths = [days[2] / max(days[0], 1.0 / 24.0) for days, _ in told]
    return [
        f"{len(looks)}", f"{len(looks) - len(told)}", rate_text(*_held(looks)), f"{early}", f"{late}",
        f"{np.median(widths):.1f}" if widths else "-",
    ]  # fmt: skip
