"""What changes is seen and named, whatever the connection, the sequence and the phase."""

from dataclasses import replace

import numpy as np
import pytest

from core.condition.assessment import Change
from core.condition.following.follower import Follower
from core.condition.kinds import Kind, State
from core.condition.verdict.judging import condition_of
from core.machines.parameters import Connection
from core.machines.winding_frame import terminal_winding
from core.signals.sequence import PhaseSequence
from tests.core.condition.simulated import HOUR_NS, PARAMETERS, Z2, Plant, follow, motor_of

BEFORE, AFTER = 60, 12
FRAMES = [(c, s) for c in Connection for s in PhaseSequence]


def changed(plant: Plant, before: int = BEFORE, after: int = AFTER, **what: object) -> Change:
    """The change that is seen after some healthy records and some with it."""
    follower = follow(motor_of(plant.connection), plant.records(before))
    healthy = follower.assessment()
    assert healthy is not None
    assert healthy.change is None
    for name, value in what.items():
        setattr(plant, name, value)
    for record in plant.records(after):
        follower.fold(record)
    assessment = follower.assessment()
    assert assessment is not None
    assert assessment.change is not None
    return assessment.change


@pytest.mark.parametrize(("connection", "sequence"), FRAMES)
@pytest.mark.parametrize("winding", [0, 1, 2])
def test_shorted_turns_are_named_with_their_phase_and_level(
    connection: Connection, sequence: PhaseSequence, winding: int
) -> None:
    change = changed(Plant(connection, sequence), level=0.01, winding=winding)
    assert Kind.SHORTED_TURNS in change.named
    assert change.level.winding == terminal_winding(winding, sequence, connection)
    low, high = change.level.ci95
    assert low < 0.01 < high
    assert low > 0.005


@pytest.mark.parametrize(("connection", "sequence"), FRAMES)
def test_a_voltage_channel_is_named_at_its_terminal(connection: Connection, sequence: PhaseSequence) -> None:
    plant = Plant(connection, sequence)
    voltage = [plant.voltage[0], plant.voltage[1] * 1.015, plant.voltage[2]]
    change = changed(plant, voltage=voltage)
    assert change.named == (Kind.VOLTAGE_CHANNEL,)
    assert change.channel == 1
    assert change.size == pytest.approx(0.015, abs=0.003)


@pytest.mark.parametrize(("connection", "sequence"), FRAMES)
def test_a_current_channel_is_named_at_its_terminal(connection: Connection, sequence: PhaseSequence) -> None:
    plant = Plant(connection, sequence)
    current = [plant.current[0], plant.current[1], plant.current[2] * 0.95]
    change = changed(plant, current=current)
    assert change.named == (Kind.CURRENT_CHANNEL,)
    assert change.channel == 2
    assert change.size == pytest.approx(-0.05, abs=0.01)


def test_a_joint_is_named_or_told_beside_shorted_turns() -> None:
    change = changed(Plant(load=(0.2, 1.0)), joint_ohm=2.0, joint=1, after=20)
    assert Kind.CONNECTION in change.named
    assert change.channel == 1


@pytest.mark.parametrize("seed", range(3))
def test_the_level_of_a_growth_that_has_stopped_stays(seed: int) -> None:
    plant = Plant(seed=seed)
    follower = follow(motor_of(), plant.records(BEFORE))
    for k in range(100):
        plant.level = 0.01 * min(k / 40, 1.0)
        follower.fold(plant.record())
    assessment = follower.assessment()
    assert assessment is not None
    assert assessment.change is not None
    low, high = assessment.change.level.ci95
    assert low < 0.01 < high
    assert high < 0.016


@pytest.mark.parametrize("ratio", [0.85, 1.25])
def test_the_interval_holds_a_level_whose_winding_is_warmer_or_colder_than_the_file(ratio: float) -> None:
    plant = Plant(path=3.0)
    motor = motor_of()
    R_s = ratio * PARAMETERS.stator_resistance_ohm
    motor = replace(motor, parameters=replace(PARAMETERS, stator_resistance_ohm=R_s))
    follower = follow(motor, plant.records(BEFORE))
    plant.level = 0.01
    for record in plant.records(60):
        follower.fold(record)
    assessment = follower.assessment()
    assert assessment is not None
    assert assessment.change is not None
    low, high = assessment.change.level.ci95
    assert low < 0.01 < high


def test_a_supply_that_jumps_changes_nothing() -> None:
    plant = Plant()
    follower = follow(motor_of(), plant.records(BEFORE))
    plant.unbalance = -0.03 + 0.02j
    for record in plant.records(30):
        follower.fold(record)
    assert not saw(follower)


@pytest.mark.parametrize("winding", [0, 1, 2])
@pytest.mark.parametrize("path", [0.0, 3.0])
@pytest.mark.parametrize("seed", range(3))
def test_turns_that_short_on_a_constant_supply_are_no_error_of_the_impedance(
    seed: int, path: float, winding: int
) -> None:
    plant = Plant(supply_swing=0.0, path=path, winding=winding, seed=seed)
    follower = follow(motor_of(), plant.records(BEFORE))
    plant.level = 0.02
    for record in plant.records(10):
        follower.fold(record)
    condition = condition_of(motor_of(), follower.assessment(), plant.time_ns)
    assert (condition.state, condition.phase) == (State.FAULT, "abc"[winding])


@pytest.mark.parametrize("error", [0.7, 1.35, 1.0 + 0.3j])
def test_a_supply_that_jumps_for_the_first_time_teaches_an_impedance_that_is_far_off(error: complex) -> None:
    class Other(Plant):
        def backward_impedance(self) -> complex:
            return Z2 * error

    plant = Other(supply_swing=0.0)
    follower = follow(motor_of(), plant.records(BEFORE))
    plant.unbalance = -0.02 + 0.01j
    for record in plant.records(30):
        follower.fold(record)
    assert not saw(follower)


def test_without_zero_voltage_a_channel_is_never_certain_to_be_shorted_turns_alone() -> None:
    plant = Plant(with_zero_voltage=False, supply_swing=0.02)
    voltage = [plant.voltage[0], plant.voltage[1], plant.voltage[2] * 1.02]
    change = changed(plant, voltage=voltage)
    assert change.probabilities[Kind.VOLTAGE_CHANNEL] > 0.02


def test_many_healthy_motors_stay_so() -> None:
    for seed in range(6):
        random = np.random.default_rng(seed)
        plant = Plant(
            list(Connection)[seed % 2],
            list(PhaseSequence)[seed // 2 % 2],
            seed=seed,
            voltage=[1.0 + complex(*random.uniform(-0.006, 0.006, 2)) for _ in range(3)],
            current=[1.0 + complex(*random.uniform(-0.006, 0.006, 2)) for _ in range(3)],
            load=(0.2, 1.0),
        )
        follower = follow(motor_of(plant.connection), plant.records(300))
        assert not saw(follower)
        assessment = follower.assessment()
        assert assessment is not None
        assert not assessment.standing_fault


def saw(follower: Follower) -> bool:
    assessment = follower.assessment()
    assert assessment is not None
    return assessment.change is not None


def test_a_fault_beside_a_channel_that_was_named_is_seen_too() -> None:
    plant = Plant()
    follower = follow(motor_of(), plant.records(BEFORE))
    plant.voltage[2] *= 1.015
    for record in plant.records(90):
        follower.fold(record)
        assert follower.assessment() is not None
    follower = Follower.restore(motor_of(), follower.save())
    assessment = follower.assessment()
    assert assessment is not None
    assert assessment.change is not None
    assert assessment.change.named == (Kind.VOLTAGE_CHANNEL,)
    assert not assessment.standing_fault
    plant.level = 0.015
    for record in plant.records(12):
        follower.fold(record)
    assessment = follower.assessment()
    assert assessment is not None
    assert assessment.change is not None
    assert Kind.SHORTED_TURNS in assessment.change.named


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("a_record", [-0.0003, 0.0005])
def test_the_size_of_a_drift_is_that_of_today(a_record: float, seed: int) -> None:
    plant = Plant(seed=seed)
    before = list(plant.voltage)
    follower = follow(motor_of(), plant.records(BEFORE))
    sizes = []
    for k in range(1, 64):
        plant.voltage = [before[0], before[1] * (1.0 + k * a_record), before[2]]
        follower.fold(plant.record())
        seen = follower.assessment()
        assert seen is not None
        if seen.change is None or not seen.change.named:
            continue
        assert seen.change.named == (Kind.VOLTAGE_CHANNEL,)
        assert seen.change.size is not None
        assert seen.change.size_ci95 is not None
        low, high = seen.change.size_ci95
        assert low < k * a_record < high
        assert high - low < 0.004 + 0.6 * abs(k * a_record)
        sizes.append(abs(seen.change.size))
    assert len(sizes) > 20
    assert sizes[-1] == pytest.approx(63 * abs(a_record), rel=0.15)
    assert sizes[-1] > 1.5 * sizes[len(sizes) // 3]


def test_a_drift_that_goes_on_after_it_has_been_learnt_is_told_as_one() -> None:
    plant = Plant()
    before = list(plant.voltage)
    follower = follow(motor_of(), plant.records(BEFORE))
    for k in range(1, 145):
        plant.voltage = [before[0], before[1] * (1.0 - 0.0006 * k), before[2]]
        follower.fold(plant.record())
    seen = follower.assessment()
    assert seen is not None
    assert seen.change is not None
    assert seen.change.named == (Kind.VOLTAGE_CHANNEL,)
    assert seen.change.since_ns < (BEFORE + 10) * HOUR_NS
    assert seen.change.size == pytest.approx(-0.0006 * 144, rel=0.1)
