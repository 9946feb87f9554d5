"""Parameters followed over records of motors that are solved by phasors of three windings."""

import cmath
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.condition.courses import Course, healthy
from benchmarks.condition.operation import COPPER_PER_K, Load, Operation, draw_operation
from benchmarks.condition.population import SimulatedMotor, draw_motor
from benchmarks.condition.records import REAL_NOISE, measure
from core.condition.observation import Observation
from core.tracking.finding import DriftCause, ParameterName, TrackedParameters, TrackingState
from core.tracking.follower import REFERENCE_RECORDS, Follower
from core.tracking.saving import document_of, follower_of
from core.tracking.telling import tracked_parameters

FIRST, RECORDS = 120, 320
CHANGED = FIRST + 20
TIMING_ERROR = 0.2
"""Of current channels that a merge has shifted against those of the voltages [rad]."""
Happening = Callable[[SimulatedMotor, Operation, Course], tuple[Operation, Course]]


def nothing(motor: SimulatedMotor, operation: Operation, course: Course) -> tuple[Operation, Course]:
    del motor
    return operation, course


def constant_supply(motor: SimulatedMotor, operation: Operation, course: Course) -> tuple[Operation, Course]:
    del motor
    return operation.on_constant_supply(), course


def other_ratio(motor: SimulatedMotor, operation: Operation, course: Course) -> tuple[Operation, Course]:
    del motor
    late = np.arange(len(course)) >= FIRST
    ratio = np.where(late, 1.0 / 1.05, 1.0)[:, np.newaxis]
    return operation, replace(course, current_ratio=course.current_ratio * ratio)


def less_magnetising(motor: SimulatedMotor, operation: Operation, course: Course) -> tuple[Operation, Course]:
    other = replace(motor.windings, magnetising_H=0.9 * motor.windings.magnetising_H)
    return operation, replace(course, rewound=(FIRST, other))


def hot(motor: SimulatedMotor, operation: Operation, course: Course) -> tuple[Operation, Course]:
    del motor
    late = np.arange(len(course)) >= FIRST
    return replace(operation, warming=operation.warming + 70.0 * COPPER_PER_K * late), course


def records(
    happening: Happening, *, load: Load = Load.RANDOM, seed: int = 6
) -> tuple[SimulatedMotor, list[Observation]]:
    random = np.random.default_rng([seed, 77])
    motor = draw_motor(random)
    operation = draw_operation(random, RECORDS, load=load)
    operation, course = happening(motor, operation, healthy(RECORDS))
    return motor, measure(random, motor, operation, course, REAL_NOISE).observations()


def followed(motor: SimulatedMotor, observations: list[Observation]) -> Follower:
    follower = Follower(motor.motor)
    for observation in observations:
        assert follower.follow(observation)
    return follower


def parameter(found: TrackedParameters, name: ParameterName) -> tuple[TrackingState, tuple[float, float]]:
    one = next(one for one in found.parameters if one.name is name)
    return one.state, one.change_ci95


@pytest.mark.parametrize("seed", range(6, 10))
def test_a_motor_that_stays_as_it_is_does_not_drift(seed: int) -> None:
    motor, observations = records(nothing, seed=seed)
    follower = Follower(motor.motor)
    for observation in observations:
        follower.follow(observation)
        assert all(drift.since_ns is None for drift in follower.drifts)
    found = tracked_parameters(follower)
    assert found.state is TrackingState.STEADY
    assert found.causes == ()
    for name in (ParameterName.MAGNETISING_INDUCTANCE, ParameterName.LEAKAGE_INDUCTANCE):
        state, (low, high) = parameter(found, name)
        assert state is TrackingState.STEADY
        assert low - 0.005 < 0.0 < high + 0.005


def test_another_ratio_is_found_at_once_and_told_from_all_else() -> None:
    motor, observations = records(other_ratio)
    found = tracked_parameters(followed(motor, observations))
    assert found.causes == (DriftCause.RATIO,)
    state, (low, high) = parameter(found, ParameterName.MAGNETISING_INDUCTANCE)
    assert state is TrackingState.DRIFTING
    assert 0.03 < low < high < 0.07
    since_ns = found.parameters[2].since_ns
    assert since_ns is not None
    assert observations[FIRST].time_ns <= since_ns < observations[FIRST + 10].time_ns


def test_a_lower_magnetising_inductance_is_told_from_another_ratio() -> None:
    motor, observations = records(less_magnetising)
    found = tracked_parameters(followed(motor, observations))
    assert found.causes == (DriftCause.MAGNETISING,)
    assert parameter(found, ParameterName.LEAKAGE_INDUCTANCE)[0] is TrackingState.STEADY


def test_a_winding_that_is_hotter_than_its_load_explains() -> None:
    motor, observations = records(hot)
    found = tracked_parameters(followed(motor, observations))
    assert found.causes == (DriftCause.WINDING_HOT,)
    assert found.winding_excess_K_ci95 is not None
    low, high = found.winding_excess_K_ci95
    assert low < 70.0 < high + 15.0
    assert parameter(found, ParameterName.MAGNETISING_INDUCTANCE)[0] is TrackingState.STEADY


def test_one_load_does_not_tell_the_parameters_apart() -> None:
    motor, observations = records(constant_supply, load=Load.CONSTANT)
    found = tracked_parameters(followed(motor, observations))
    leakage = next(one for one in found.parameters if one.name is ParameterName.LEAKAGE_INDUCTANCE)
    assert leakage.state is TrackingState.UNDETERMINED
    assert leakage.value is None
    assert any("load would tell most" in reason for reason in leakage.reasons)


def test_nothing_is_told_before_there_is_a_reference() -> None:
    motor, observations = records(nothing)
    found = tracked_parameters(followed(motor, observations[: REFERENCE_RECORDS - 1]))
    assert found.state is TrackingState.UNDETERMINED
    assert not found.reference_complete
    assert all("first records are there" in one.reasons[0] for one in found.parameters)


def with_starts(growth: float) -> TrackedParameters:
    """A motor with a start every forty records; R_r over R_s grows from the fourth one on."""
    motor, observations = records(constant_supply)
    machine, follower = motor.motor.parameters, Follower(motor.motor)
    file = machine.rotor_resistance_ohm / machine.stator_resistance_ohm
    for number, observation in enumerate(observations):
        follower.follow(observation)
        if number % 40 == 10:
            follower.follow_start(observation.time_ns, 1.3 * file * (1.0 + (number >= FIRST) * growth), 0.01)
    return tracked_parameters(follower)


def test_starts_tell_that_the_rotor_gets_worse() -> None:
    found = with_starts(0.3)
    state, (low, high) = parameter(found, ParameterName.ROTOR_RESISTANCE)
    assert state is TrackingState.DRIFTING
    assert found.causes == (DriftCause.ROTOR,)
    assert low < 0.3 < high + 0.02
    assert parameter(with_starts(0.0), ParameterName.ROTOR_RESISTANCE)[0] is TrackingState.STEADY


def test_running_alone_does_not_tell_the_rotor_where_the_unbalance_is_constant() -> None:
    motor, observations = records(constant_supply)
    found = tracked_parameters(followed(motor, observations))
    rotor = next(one for one in found.parameters if one.name is ParameterName.ROTOR_RESISTANCE)
    assert rotor.state is TrackingState.UNDETERMINED
    assert any("a recorded start tells it" in reason for reason in rotor.reasons)


def test_a_single_odd_record_is_not_believed() -> None:
    motor, observations = records(nothing)
    odd = replace(observations[200], positive_current_A=1.1 * observations[200].positive_current_A)
    usual = tracked_parameters(followed(motor, observations))
    found = tracked_parameters(followed(motor, [*observations[:200], odd, *observations[201:]]))
    assert found.state is TrackingState.STEADY
    before = [one.change_ci95 for one in usual.parameters]
    after = [one.change_ci95 for one in found.parameters]
    np.testing.assert_allclose(after, before, atol=0.02)


def test_other_sensors_of_the_class_are_no_drift() -> None:
    motor, observations = records(nothing)
    other = [
        replace(one, recorder="another", positive_current_A=0.995 * one.positive_current_A)
        for one in observations[FIRST:]
    ]
    found = tracked_parameters(followed(motor, [*observations[:FIRST], *other]))
    assert found.state is not TrackingState.DRIFTING


def test_a_follower_goes_on_as_before_from_its_document() -> None:
    motor, observations = records(hot)
    whole = followed(motor, observations)
    first = followed(motor, observations[:CHANGED])
    again = follower_of(motor.motor, document_of(first))
    for observation in observations[CHANGED:]:
        again.follow(observation)
    np.testing.assert_allclose(again.x, whole.x, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(again.P, whole.P, rtol=1e-6, atol=1e-12)
    told, expected = tracked_parameters(again), tracked_parameters(whole)
    assert (told.state, told.causes, told.records) == (expected.state, expected.causes, expected.records)
    assert again.drifts == whole.drifts


def test_impossible_records_do_not_count() -> None:
    motor, observations = records(nothing)
    follower = followed(motor, observations[:40])
    before = document_of(follower)
    assert not follower.follow(replace(observations[40], positive_current_A=complex("nan")))
    assert not follower.follow(replace(observations[40], positive_current_A=0j))
    assert document_of(follower) == before


def test_records_of_no_motor_are_no_drift() -> None:
    motor, observations = records(nothing)
    late = cmath.exp(TIMING_ERROR * 1j)
    others = [replace(one, positive_current_A=late * one.positive_current_A) for one in observations[FIRST:]]
    found = tracked_parameters(followed(motor, [*observations[:FIRST], *others]))
    assert found.state is TrackingState.UNDETERMINED
    assert found.causes == ()
    for one in found.parameters:
        assert (one.state, one.value, one.since_ns) == (TrackingState.UNDETERMINED, None, None)
        assert one.reasons[0].startswith("no motor explains the records: by them less than nothing")
        assert "check the channels, their ratios and the motor file" in one.reasons[0]
