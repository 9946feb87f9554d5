"""Machines that the filter's equations do not describe: iron that saturates, deep bars, deltas, years."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.condition.courses import healthy, shape, with_fault
from benchmarks.condition.following import follow, said_of
from benchmarks.condition.operation import Load, Times, draw_operation
from benchmarks.condition.population import SimulatedMotor, draw_motor
from benchmarks.condition.records import REAL_NOISE, measure
from core.condition.following.follower import Follower
from core.condition.kinds import State
from core.machines.parameters import Connection

BEFORE, AFTER = 100, 60
SEEDS = [0, 1, *(pytest.param(seed, marks=pytest.mark.campaign) for seed in range(2, 12))]


def drawn(
    seed: int, *, delta: bool | None = None, span: float = 0.1
) -> tuple[np.random.Generator, SimulatedMotor]:
    """A motor, and the random numbers of its records."""
    random = np.random.default_rng([seed, 77])
    while True:
        simulated = draw_motor(random, parameter_span=span)
        if delta is None or delta is (simulated.motor.nameplate.connection is Connection.DELTA):
            return random, simulated


def expect_a_fault_and_no_false_alarm(
    random: np.random.Generator, simulated: SimulatedMotor, *, voltage_swing: float = 1.0
) -> None:
    """Follow a healthy motor that gets 2 % of shorted turns."""
    records, winding = BEFORE + AFTER, int(random.integers(3))
    operation = draw_operation(random, records, load=Load.RANDOM)
    swing = 1.0 + voltage_swing * (operation.relative_voltage - operation.relative_voltage.mean())
    operation = replace(operation, relative_voltage=swing)
    course = with_fault(healthy(records), winding, 0.02 * shape(records, BEFORE), 1.0)
    observations = measure(random, simulated, operation, course, REAL_NOISE).observations()
    said = list(follow(simulated.motor, observations))
    assert not any(one.changed for one in said[:BEFORE])
    assert said[-1].condition.state is State.FAULT
    assert said[-1].condition.phase == "abc"[simulated.terminal(winding)]


@pytest.mark.parametrize("seed", SEEDS)
def test_iron_that_saturates_with_the_voltage(seed: int) -> None:
    random, simulated = drawn(seed)
    # Ten percent more voltage take a third of the magnetising inductance.
    expect_a_fault_and_no_false_alarm(random, replace(simulated, saturation=3.0), voltage_swing=2.0)


@pytest.mark.parametrize("seed", SEEDS)
def test_deep_bars_and_parameters_that_are_off_by_a_quarter(seed: int) -> None:
    random, simulated = drawn(seed, span=0.25)
    deep = replace(simulated.windings, backward_resistance=np.array([2.5]), backward_leakage=np.array([0.75]))
    expect_a_fault_and_no_false_alarm(random, replace(simulated, windings=deep))


@pytest.mark.parametrize("seed", SEEDS)
def test_the_windings_of_a_delta(seed: int) -> None:
    expect_a_fault_and_no_false_alarm(*drawn(seed, delta=True))


@pytest.mark.parametrize(
    ("records", "times"),
    [(2_000, Times.DAILY), pytest.param(26_000, Times.HOURLY, marks=pytest.mark.campaign)],
)
def test_years_of_history_raise_no_alarm_and_see_a_fault_at_their_end(records: int, times: Times) -> None:
    random, simulated = drawn(3)
    operation = draw_operation(random, records + AFTER, times=times)
    course = with_fault(healthy(records + AFTER), 1, 0.015 * shape(records + AFTER, records), 0.5)
    follower = Follower(simulated.motor)
    for k, one in enumerate(measure(random, simulated, operation, course, REAL_NOISE).observations()):
        follower.fold(one)
        if k < records and k % 100 == 99:
            assert not said_of(follower, simulated.motor, k).changed
    condition = said_of(follower, simulated.motor, records).condition
    assert condition.state is State.FAULT
    assert condition.phase == "abc"[simulated.terminal(1)]
