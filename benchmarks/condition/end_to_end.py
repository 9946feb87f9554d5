"""Motors followed over records in time that went through COMTRADE files, alone and on a bus."""

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from benchmarks.condition.disturbances import outcome_row
from benchmarks.condition.file_records import PATHS, SENSORS, Case, Course, through_files, with_supply_step
from benchmarks.condition.following import Outcome, follow, follow_together, outcome, quantile_text
from benchmarks.condition.marks import Mark, at_least, at_most
from benchmarks.condition.operation import Operation, draw_operation
from benchmarks.reporting import spread, table
from core.condition.kinds import Kind, State
from core.condition.observation import Observation
from core.machines.parameters import Motor
from testing.machines.motors import LARGE, MEDIUM, REFERENCE, VERY_LARGE

MOTORS: Final = (REFERENCE, MEDIUM, LARGE, VERY_LARGE)
ON_A_BUS: Final = (MEDIUM, REFERENCE, LARGE, VERY_LARGE, MEDIUM)
BUS_CASES: Final = (*PATHS, Case.VOLTAGE_DRIFT, Case.SUPPLY)
BEFORE, AFTER = 60, 100
MOST_AFTER_ON_A_BUS: Final = 60
ACB_SHARE: Final = 0.4
APART: Final = 1e-4
"""Of V2/V1 between records of a bus, which are made within a minute."""
SEEN_WITHIN: Final = 10
LEAST_SEEN = LEAST_CALLED = 0.97
LEAST_PHASE: Final = 0.995
MOST_CALLED, MOST_CALLED_ON_A_BUS = 0.02, 0.01
DISTURBANCES: Final = tuple(case for case in Case if case is not Case.HEALTHY and case not in PATHS)


@dataclass(frozen=True, slots=True)
class Task:
    """One motor with a case, by its number."""

    motor: Motor
    case: Case
    number: int
    before: int = BEFORE
    after: int = AFTER


@dataclass(frozen=True, slots=True)
class BusTask:
    """One motor of a bus, by the numbers of both; the case is that of the first motor, or of the supply."""

    case: Case
    number: int
    place: int
    before: int = BEFORE
    after: int = AFTER

    @property
    def motor(self) -> Motor:
        return replace(ON_A_BUS[self.place], name=f"motor {self.place}", sensors=SENSORS)


@dataclass(frozen=True, slots=True)
class Result:
    """What came of a motor, alone or first on its bus.

    right: whether the phase is.  refused, unhealthy: records that were, and that left the motor other than
    healthy.  others_called: motors of the same bus that were a fault at their last.
    """

    outcome: Outcome
    right: bool
    records: int
    refused: int
    unhealthy: int
    others: int = 0
    others_called: int = 0


def follow_files(task: Task) -> Result:
    """Send the records of a motor through files and follow it."""
    random = np.random.default_rng([task.number, 7, list(Case).index(task.case), MOTORS.index(task.motor)])
    motor = replace(task.motor, sensors=SENSORS)
    operation = draw_operation(random, task.before + task.after)
    if task.case is Case.SUPPLY:
        operation = with_supply_step(random, operation, task.before)
    winding = int(random.integers(3))
    reverse = bool(random.uniform() < ACB_SHARE)
    course = Course(motor, task.case, task.before, winding, operation, reverse, task.number)
    observations = through_files(course, random)
    kept = [one for one in observations if one is not None]
    said = list(follow(motor, kept))
    found = outcome(said, sum(one is not None for one in observations[: task.before]))
    return Result(
        outcome=found,
        right=found.phase == "abc"[winding],
        records=len(observations),
        refused=len(observations) - len(kept),
        unhealthy=sum(one.condition.state is not State.HEALTHY for one in said),
    )


def observe_on_bus(task: BusTask) -> list[Observation | None]:
    """Send the records of one motor of a bus through files."""
    supply, winding, reverse = _bus(task)
    random = np.random.default_rng([task.number, 9, list(Case).index(task.case), task.place])
    records = len(supply)
    own = draw_operation(random, records).on_supply(supply)
    apart = random.standard_normal(records) + 1j * random.standard_normal(records)
    operation = replace(own, unbalance=own.unbalance + APART / np.sqrt(2) * apart)
    happens = task.place == 0 or task.case is Case.SUPPLY
    case = task.case if happens else Case.HEALTHY
    seed = 1_000 * (task.number + 1) + task.place
    return through_files(Course(task.motor, case, task.before, winding, operation, reverse, seed), random)


def _bus(task: BusTask) -> tuple[Operation, int, bool]:
    """The supply of a bus, the winding of its first motor's fault, and whether it turns a-c-b."""
    random = np.random.default_rng([task.number, 8, list(Case).index(task.case)])
    supply = draw_operation(random, task.before + task.after)
    if task.case is Case.SUPPLY:
        supply = with_supply_step(random, supply, task.before)
    return supply, int(random.integers(3)), bool(random.uniform() < ACB_SHARE)


def _followed_bus(tasks: Sequence[BusTask], every: Sequence[list[Observation | None]]) -> Result:
    first, observations = tasks[0], every[0]
    records = len(observations)
    said, others = follow_together([one.motor for one in tasks], every, range(records), compared=True)
    found = outcome(said, first.before)
    _, winding, _ = _bus(first)
    return Result(
        outcome=found,
        right=found.phase == "abc"[winding],
        records=sum(len(one) for one in every),
        refused=sum(record is None for one in every for record in one),
        unhealthy=sum(one.condition.state is not State.HEALTHY for one in said),
        others=len(others),
        others_called=sum(one.condition.state is State.FAULT for one in others),
    )


def end_to_end(
    each: int, pool: Executor, *, before: int = BEFORE, after: int = AFTER
) -> Iterator[str | Mark]:
    """Marks, and tables of the cases over all motors and of buses."""
    alone = {}
    for case in Case:
        tasks = [Task(motor, case, number, before, after) for motor in MOTORS for number in range(each)]
        alone[case] = list(spread(follow_files, tasks, f"files, {case.value}", pool))
    on_a_bus = {}
    on_a_bus_after = min(after, MOST_AFTER_ON_A_BUS)
    for case in BUS_CASES:
        buses = [
            [BusTask(case, number, place, before, on_a_bus_after) for place in range(len(ON_A_BUS))]
            for number in range(each)
        ]
        tasks_of_all = [task for one in buses for task in one]
        found = list(spread(observe_on_bus, tasks_of_all, f"files of a bus, {case.value}", pool))
        of_each = [found[k : k + len(ON_A_BUS)] for k in range(0, len(found), len(ON_A_BUS))]
        on_a_bus[case] = [_followed_bus(one, every) for one, every in zip(buses, of_each, strict=True)]
    yield from _marks(alone, "alone", after, MOST_CALLED)
    yield from _marks(on_a_bus, "on a bus", on_a_bus_after, MOST_CALLED_ON_A_BUS)
    drifts = [one.outcome.final == (Kind.VOLTAGE_CHANNEL,) for one in on_a_bus[Case.VOLTAGE_DRIFT]]
    yield at_least(f"on a bus, {Case.VOLTAGE_DRIFT.value}: named so", sum(drifts), len(drifts), 1.0)
    every_bus = [one for found in on_a_bus.values() for one in found]
    others = sum(one.others for one in every_bus)
    called = sum(one.others_called for one in every_bus)
    yield at_most("on a bus: other motors called `fault`", called, others, 0.0)
    yield "Each motor alone:"
    yield ""
    yield from _table("motors", alone)
    yield ""
    yield f"Buses of {len(ON_A_BUS)} motors recorded together, with {on_a_bus_after} records after the case."
    yield "Supply steps happen to all of them, the other cases to the first one, of which this tells:"
    yield ""
    yield from _table("buses", on_a_bus)


Found = dict[Case, list[Result]]


def _marks(found: Found, where: str, within: int, most_called: float) -> Iterator[Mark]:
    faults = [one for case in PATHS for one in found[case]]
    seen = sum(one.outcome.seen is not None and one.outcome.seen < SEEN_WITHIN for one in faults)
    called = _called(faults)
    yield at_least(f"{where}, 1 %: seen within {SEEN_WITHIN} records", seen, len(faults), LEAST_SEEN)
    yield at_least(f"{where}, 1 %: `fault` within {within} records", len(called), len(faults), LEAST_CALLED)
    right = sum(one.right for one in called)
    yield at_least(f"{where}, 1 %: phase right in all called", right, len(called), LEAST_PHASE)
    every = [one for some in found.values() for one in some]
    before = sum(one.outcome.alarmed_before for one in every)
    yield at_most(f"{where}: an alarm before the case", before, len(every), 0.0)
    if Case.HEALTHY in found:
        healthy = found[Case.HEALTHY]
        alarms = sum(_alarmed(one) for one in healthy)
        yield at_most(f"{where}, healthy: any alarm", alarms, len(healthy), 0.0)
    for case in DISTURBANCES:
        if case in found:
            what = f"{where}, {case.value}: called `fault`"
            yield at_most(what, len(_called(found[case])), len(found[case]), most_called)
    supply = found[Case.SUPPLY]
    alarms = sum(_alarmed(one) for one in supply)
    yield at_most(f"{where}, {Case.SUPPLY.value}: any alarm", alarms, len(supply), 0.0)


def _called(found: Sequence[Result]) -> list[Result]:
    return [one for one in found if one.outcome.called_fault is not None]


def _alarmed(one: Result) -> bool:
    found = one.outcome
    return found.seen is not None or found.alarmed_before or found.called_fault is not None


def _table(what: str, found: Found) -> list[str]:
    header = [
        "case", what, "records", "refused", "seen", "by record, median", "called `fault`",
        "by record, median", "phase right", "in the end", "records other than healthy",
    ]  # fmt: skip
    return table(header, [[case.value, *_row(case, every)] for case, every in found.items()])


def _row(case: Case, found: Sequence[Result]) -> list[str]:
    outcomes = [one.outcome for one in found]
    called = _called(found)
    seen = np.array([one.seen for one in outcomes if one.seen is not None], dtype=np.float64)
    delays = np.array([one.outcome.called_fault for one in called], dtype=np.float64)
    return [
        f"{len(found)}", f"{sum(one.records for one in found):,}", f"{sum(one.refused for one in found)}",
        f"{len(seen)}", quantile_text(seen), f"{len(called)}", quantile_text(delays),
        f"{sum(one.right for one in called)} of {len(called)}" if case in PATHS else "-",
        outcome_row(outcomes)[1], f"{sum(one.unhealthy for one in found)}",
    ]  # fmt: skip
