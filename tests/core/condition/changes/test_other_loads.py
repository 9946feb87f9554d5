"""What hangs behind the relay beside a motor: it is no fault of the motor, and hides none for long."""

import numpy as np
import pytest

from core.condition.following.follower import Follower
from core.condition.kinds import Kind, State
from core.condition.verdict.condition import Condition
from core.condition.verdict.judging import condition_of
from core.machines.parameters import Connection
from core.signals.sequence import PhaseSequence
from tests.core.condition.simulated import PARAMETERS, Plant, W, follow, motor_of

BEFORE, AFTER = 50, 40
MAGNETISING = 1.0 / (W * (PARAMETERS.magnetising_inductance_H + PARAMETERS.stator_leakage_H))
RATED_A = 800.0 / 0.75 / (3.0 * 220.0)
HEATER = 0.06 * RATED_A / 380.0
FRAMES = [(c, s) for c in Connection for s in PhaseSequence]


def conditions(follower: Follower, plant: Plant, records: int) -> list[Condition]:
    """What is told after each of so many records."""
    found = []
    for record in plant.records(records):
        follower.fold(record)
        found.append(condition_of(motor_of(plant.connection), follower.assessment(), plant.time_ns))
    return found


def may_be_another_load(one: Condition) -> bool:
    return Kind.OTHER_LOAD in (one.candidates or (one.kind,))


@pytest.mark.parametrize(("connection", "sequence"), FRAMES)
@pytest.mark.parametrize("lost", [0, 1, 2])
@pytest.mark.parametrize("seed", range(2))
def test_a_capacitor_that_is_lost_is_no_fault(
    connection: Connection, sequence: PhaseSequence, lost: int, seed: int
) -> None:
    element = 0.4j * MAGNETISING / 3.0 * (3.0 if connection is Connection.DELTA else 1.0)
    plant = Plant(connection, sequence, seed=seed, elements=[element] * 3, load=(0.3, 1.0))
    follower = follow(motor_of(connection), plant.records(BEFORE))
    plant.elements[lost] = 0j
    told = conditions(follower, plant, AFTER)
    assert all(one.state is not State.FAULT for one in told)
    assert told[-1].state is State.WATCH
    assert may_be_another_load(told[-1])


@pytest.mark.parametrize(("connection", "sequence"), FRAMES)
@pytest.mark.parametrize("between", [0, 1, 2])
@pytest.mark.parametrize("size", [1.0, 2.0])
def test_a_heater_between_two_lines_is_no_fault(
    connection: Connection, sequence: PhaseSequence, between: int, size: float
) -> None:
    plant = Plant(connection, sequence, load=(0.3, 1.0))
    follower = follow(motor_of(connection), plant.records(BEFORE))
    plant.elements[between] = size * HEATER
    told = conditions(follower, plant, AFTER)
    assert all(one.state is not State.FAULT for one in told)
    assert told[-1].state is State.WATCH


@pytest.mark.parametrize(("connection", "sequence"), FRAMES)
@pytest.mark.parametrize("size", [0.3, 1.0])
def test_a_second_motor_is_told_as_another_load(
    connection: Connection, sequence: PhaseSequence, size: float
) -> None:
    plant = Plant(connection, sequence, load=(0.3, 1.0))
    follower = follow(motor_of(connection), plant.records(BEFORE))
    plant.others = size
    told = conditions(follower, plant, AFTER)
    assert all(one.state is not State.FAULT for one in told)
    assert (told[-1].state, told[-1].kind) == (State.WATCH, Kind.OTHER_LOAD)
    assert "another load behind the relay" in told[-1].reasons[0]


@pytest.mark.parametrize("level", [0.05, 0.02])
@pytest.mark.parametrize("angle", [np.pi / 2.0, 0.0])
def test_turns_that_short_after_an_element_was_connected_are_a_fault(level: float, angle: float) -> None:
    plant = Plant(load=(0.3, 1.0))
    follower = follow(motor_of(), plant.records(BEFORE))
    plant.elements[1] = HEATER * np.exp(1j * angle)
    assert all(one.state is not State.FAULT for one in conditions(follower, plant, AFTER))
    plant.level, plant.winding = level, 2
    told = conditions(follower, plant, 10)[-1]
    assert (told.state, told.phase) == (State.FAULT, "c")


@pytest.mark.parametrize("angle", [np.pi / 2.0, 0.0])
def test_the_size_of_an_element_is_that_of_its_current(angle: float) -> None:
    plant = Plant(load=(0.2, 1.0))
    follower = follow(motor_of(), plant.records(BEFORE))
    plant.elements[1] = HEATER * np.exp(1j * angle)
    told = conditions(follower, plant, AFTER)[-1]
    assert (told.state, told.kind, told.phase) == (State.WATCH, Kind.OTHER_LOAD, None)
    assert told.size == pytest.approx(0.06, rel=0.1)
    assert told.size_ci95 is not None
    assert told.size_ci95[0] < 0.06 < told.size_ci95[1]
