"""The level of a fault that stands from the first record on."""

from dataclasses import replace

import numpy as np
import pytest

from core.condition.assessment import Assessment
from core.condition.events import Event, EventKind
from core.condition.following.follower import Follower
from core.condition.following.standing import (
    STANDING_SCORE,
    Called,
    held,
    score_of,
    standing_of,
    surest,
)
from core.condition.following.standing_errors import StandingErrors
from core.condition.kinds import Kind, State
from core.condition.measuring.turns_grid import FINE, ROUGH, turns_grid
from core.condition.verdict.judging import condition_of
from core.diagnosis.channel_errors import A
from core.machines.sensors import SensorClass
from core.signals.sequence import PhaseSequence
from tests.core.condition.simulated import Plant, follow, motor_of


@pytest.mark.parametrize("leakage", [0.05, 0.2, 0.5, 0.9])
@pytest.mark.parametrize("axis_deg", [-20.0, 0.0, 16.0])
@pytest.mark.parametrize("astray", [1.5, -1.5])
def test_the_interval_holds_the_level_whatever_axis_and_leakage(
    leakage: float, axis_deg: float, astray: float
) -> None:
    motor, deviation = motor_of(), 0.003
    grid, known = (turns_grid(motor, PhaseSequence.ABC, 25.0, steps) for steps in (FINE, ROUGH))
    node = int(np.argmin(np.abs(grid.axis_rad - np.radians(axis_deg)) * 10 + np.abs(grid.leakage - leakage)))
    u = 0.03 * A * complex(grid.y[node])
    across = 1j * u / abs(u) * astray * deviation
    asymmetry = np.array([(u + across).real, (u + across).imag])
    standing = standing_of(known, asymmetry, deviation**2 * np.eye(2), from_bus=False)
    low, high = standing.interval
    assert low < 0.03 < high
    assert low <= standing.level <= high


def test_the_assessment_tells_that_interval() -> None:
    assessment = follow(motor_of(), Plant(level=0.03, path=0.0).records(20)).assessment()
    assert assessment is not None
    standing = assessment.reference.standing
    assert standing.interval is not None
    low, high = standing.ci95
    assert low < 0.03 < high


@pytest.mark.parametrize("winding", [0, 1, 2])
def test_a_fault_on_a_constant_supply_does_not_come_to_stand(winding: int) -> None:
    """The filter takes it for an error of the impedance: only their priors tell that from E."""
    plant = Plant(supply_swing=0.0, unbalance=0.02, seed=1, winding=winding)
    follower = follow(motor_of(), plant.records(60))
    healthy = follower.assessment()
    plant.level = 0.03
    for record in plant.records(12):
        follower.fold(record)
    faulty = follower.assessment()
    assert healthy is not None
    assert faulty is not None
    assert faulty.change is not None
    assert faulty.change.level.winding == winding
    assert faulty.reference.standing_score == pytest.approx(healthy.reference.standing_score, abs=0.2)


def test_a_fault_that_grows_on_a_constant_supply_does_not_come_to_stand() -> None:
    plant = Plant(supply_swing=0.0, unbalance=0.02, seed=1)
    follower = follow(motor_of(), plant.records(60))
    for _ in range(20):
        plant.level += 0.002
        follower.fold(plant.record())
        assessment = follower.assessment()
        assert assessment is not None
        assert assessment.reference.standing_score < 3.2


def assessed(follower: Follower) -> Assessment:
    assessment = follower.assessment()
    assert assessment is not None
    return assessment


def test_a_called_fault_does_not_fade_while_a_second_change_is_not_yet_seen() -> None:
    motor = replace(motor_of(), sensors=SensorClass(0.005, 0.005, 10e-6, 10e-6))
    plant = Plant(level=0.04, noise=5e-4)
    follower = follow(motor, plant.records(60))
    called = condition_of(motor, assessed(follower), 0)
    assert called.mu_f is not None
    plant.joint_ohm, plant.joint = 6.0, 1
    for record in plant.records(15):
        follower.fold(record)
        condition = condition_of(motor, assessed(follower), record.time_ns)
        assert (condition.state, condition.phase) == (State.FAULT, "a")
        assert condition.mu_f == pytest.approx(called.mu_f, rel=0.2)
        assert condition.mu_f_ci95 is not None
        low, high = condition.mu_f_ci95
        assert low < plant.level < high
    assert assessed(follower).change is not None, "the second change is seen by now"


@pytest.mark.parametrize("unbalance", [0.009 + 0.008j, 0.03j])
@pytest.mark.parametrize("supply_swing", [0.0, 3e-4, 6e-4, 1e-3])
def test_an_impedance_that_varies_is_no_fault_on_a_supply_that_hardly_changes(
    supply_swing: float, unbalance: complex
) -> None:
    """The currents vary with it, so that the filter takes Z2 for ever smaller, and E for what remains."""
    motor = replace(motor_of(), sensors=SensorClass(0.002, 0.005, 10e-6, 25e-6))
    plant = Plant(
        supply_swing=supply_swing,
        unbalance=unbalance,
        voltage=[1.001, 0.9995, 1.0005],
        current=[0.999, 1.001, 1.0],
    )
    follower = Follower(motor)
    for _ in range(10):
        for record in plant.records(80):
            follower.fold(record)
        assessment = follower.assessment()
        assert assessment is not None
        assert assessment.reference.standing_score < 3.0


def test_a_called_fault_does_not_wear_away_on_a_constant_supply() -> None:
    """The filter takes ever more of it for an error of the impedance."""
    motor, plant = motor_of(), Plant(level=0.1, supply_swing=0.0)
    follower = follow(motor, plant.records(400))
    assessment = Follower.restore(motor, follower.save()).assessment()
    assert assessment == follower.assessment()
    assert assessment is not None
    standing = assessment.reference.standing
    assert standing.value == pytest.approx(0.1, rel=0.2)
    low, high = standing.ci95
    assert low < 0.1 < high
    assert assessment.reference.standing_score > 5.0


def test_another_class_of_sensors_counts_at_once_and_as_if_it_had_from_the_first_record_on() -> None:
    coarse = motor_of()
    fine = replace(coarse, sensors=replace(coarse.sensors, voltage_gain=coarse.sensors.voltage_gain / 4.0))
    follower = follow(coarse, Plant(level=0.02).records(60))
    before = follower.assessment()
    follower.apply(Event(0, EventKind.PARAMETERS_EDITED), fine)
    edited = follower.assessment()
    assert Follower.restore(fine, follower.save()).assessment() == edited
    other = follow(fine, Plant(level=0.02).records(60)).assessment()
    assert before is not None
    assert edited is not None
    assert other is not None
    assert edited.reference.standing_score > 1.2 * before.reference.standing_score
    assert edited.reference.standing_score == pytest.approx(other.reference.standing_score, rel=0.1)
    assert edited.reference.standing.value == pytest.approx(other.reference.standing.value, rel=0.1)


@pytest.mark.parametrize("kind", sorted(EventKind))
def test_any_event_may_come_with_finer_sensors(kind: EventKind) -> None:
    coarse = replace(motor_of(), sensors=SensorClass(0.01, 0.01, 50e-6, 50e-6))
    fine = replace(coarse, sensors=SensorClass(0.001, 0.001, 5e-6, 5e-6))
    plant = Plant(load=(0.9, 0.9), supply_swing=0.0)
    follower = follow(coarse, plant.records(40))
    follower.apply(Event(plant.time_ns, kind), fine)
    assert Follower.restore(fine, follower.save()).assessment() == follower.assessment()
    for record in plant.records(20):
        follower.fold(record)
        assessment = follower.assessment()
        assert assessment is not None
        assert 0.0 <= assessment.reference.standing_score < 100.0


def test_a_called_fault_is_held_against_a_coarser_class() -> None:
    fine = replace(motor_of(), sensors=SensorClass(0.002, 0.002, 5e-6, 5e-6))
    coarse = replace(fine, sensors=SensorClass(0.03, 0.03, 200e-6, 200e-6))
    follower = follow(fine, Plant(level=0.01).records(60))
    before = follower.assessment()
    follower.apply(Event(0, EventKind.PARAMETERS_EDITED), coarse)
    after = follower.assessment()
    assert before is not None
    assert before.standing_fault
    assert after is not None
    assert not after.standing_fault


def test_a_fault_that_was_called_is_one_no_more_where_all_of_it_lies_below_the_limit() -> None:
    motor = motor_of()
    follower = follow(motor, Plant(level=0.03).records(60))
    surer = follow(motor, Plant(level=0.1).records(60))._directions[-1]._errors()
    follower._directions[-1].state.header.called = Called(surer, 9.0, 0.1)
    kept = follower.assessment()
    lenient = replace(motor, limits=replace(motor.limits, fault_level=0.5))
    follower.apply(Event(0, EventKind.PARAMETERS_EDITED), lenient)
    now = follower.assessment()
    assert kept is not None
    assert now is not None
    assert kept.reference.standing.value == pytest.approx(0.1, rel=0.2)
    assert now.reference.standing.value == pytest.approx(0.03, rel=0.2), "what the records tell now"


def test_a_standing_fault_is_kept_as_it_was_told_surest() -> None:
    errors = StandingErrors(0.01, 0.0, [1e-6, 0.0, 1e-6], [1e-6, 0.0, 1e-6], 0.0, 0.0, 0, 1)
    grid = turns_grid(motor_of(), PhaseSequence.ABC, 25.0, ROUGH)
    score = score_of(grid, errors)
    called = surest(grid, errors, score, None)
    assert called is not None
    assert surest(grid, errors, STANDING_SCORE - 0.1, None) is None
    assert surest(grid, errors, score - 0.1, called) is called


@pytest.mark.parametrize(("score", "before", "after"), [(3.0, 3.3, 3.3), (3.0, 3.9, 3.5), (3.0, 0.0, 3.0)])
def test_a_score_is_held_while_it_falls_by_little(score: float, before: float, after: float) -> None:
    assert held(score, before) == after


@pytest.mark.parametrize(("level", "kept"), [(0.03, True), (0.0, False)])
def test_a_fault_that_was_called_outlasts_a_change_unless_it_was_its_beginning(
    level: float, kept: bool
) -> None:
    motor, plant = motor_of(), Plant(level=level)
    follower = follow(motor, plant.records(60))
    header = follower._directions[-1].state.header
    assert (header.called is not None) is kept
    header.called = Called(follow(motor, Plant(level=0.03).records(60))._directions[-1]._errors(), 9.0, 0.03)
    plant.voltage[2] *= 1.04
    for record in plant.records(90):
        follower.fold(record)
    assessment = follower.assessment()
    assert assessment is not None
    assert assessment.change is not None
    assert assessment.change.named == (Kind.VOLTAGE_CHANNEL,)
    assert assessment.standing_fault is kept
    assert assessment.called_above == (0.03 if kept else 0.0)
