"""What must not matter to a follower: how records arrive, scale, sequence and the names of the phases."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.condition.assessment import Assessment
from core.condition.events import Event, EventKind
from core.condition.following.follower import Follower
from core.condition.kinds import Kind, State
from core.condition.observation import Observation
from core.condition.verdict.judging import condition_of
from core.machines.parameters import Connection
from core.signals.sequence import PhaseSequence
from tests.core.condition.simulated import HOUR_NS, Plant, follow, motor_of

MOST_BYTES = 50_000


def with_a_fault(plant: Plant, count: int = 40) -> list[Observation]:
    records = plant.records(count)
    plant.level = 0.01
    return records + plant.records(12)


def assessed(follower: Follower) -> Assessment:
    assessment = follower.assessment()
    assert assessment is not None
    return assessment


@settings(deadline=None, max_examples=15)
@given(cuts=st.lists(st.integers(0, 52), max_size=4))
def test_saving_and_restoring_in_between_changes_no_bit(cuts: list[int]) -> None:
    motor, records = motor_of(), with_a_fault(Plant())
    follower = Follower(motor)
    for k, record in enumerate(records):
        if k in cuts:
            state = follower.save()
            assert len(state) < MOST_BYTES
            follower = Follower.restore(motor, state)
        follower.fold(record)
    whole = follow(motor, records)
    assert follower.save() == whole.save()
    assert follower.assessment() == whole.assessment()


def test_assessing_changes_nothing() -> None:
    motor, records = motor_of(), with_a_fault(Plant())
    follower = Follower(motor)
    for record in records:
        follower.fold(record)
        follower.assessment()
    assert follower.save() == follow(motor, records).save()


@settings(deadline=None, max_examples=8)
@given(exponent=st.integers(-6, 6))
def test_the_scale_of_voltages_and_currents_does_not_matter(exponent: int) -> None:
    usual = assessed(follow(motor_of(), with_a_fault(Plant())))
    scaled = assessed(follow(motor_of(), with_a_fault(Plant(scale=10.0**exponent))))
    assert usual.change is not None
    assert scaled.change is not None
    assert scaled.statistic == pytest.approx(usual.statistic, rel=1e-6)
    # The voltage over the rated one tells how far the iron saturates.
    assert scaled.change.level.value == pytest.approx(usual.change.level.value, rel=1e-4)
    assert scaled.change.named == usual.change.named


@settings(deadline=None, max_examples=8)
@given(angle=st.floats(0.0, 6.28))
def test_the_angle_at_which_a_record_begins_does_not_matter(angle: float) -> None:
    turn = complex(np.exp(1j * angle))
    records = with_a_fault(Plant())
    turned = [
        replace(
            o,
            positive_voltage_V=o.positive_voltage_V * turn,
            negative_voltage_V=o.negative_voltage_V * turn,
            zero_voltage_V=None if o.zero_voltage_V is None else o.zero_voltage_V * turn,
            positive_current_A=o.positive_current_A * turn,
            negative_current_A=o.negative_current_A * turn,
            zero_current_A=o.zero_current_A * turn,
        )
        for o in records
    ]
    usual, other = assessed(follow(motor_of(), records)), assessed(follow(motor_of(), turned))
    assert other.statistic == pytest.approx(usual.statistic, rel=1e-6)


@pytest.mark.parametrize("connection", Connection)
def test_a_mirrored_sequence_gives_the_same_with_phases_b_and_c_exchanged(connection: Connection) -> None:
    motor, usual_plant = motor_of(connection), Plant(connection, noise=1e-5)
    mirrored = Plant(connection, PhaseSequence.ACB, noise=1e-5)
    mirrored.voltage = [usual_plant.voltage[k] for k in (0, 2, 1)]
    mirrored.current = [usual_plant.current[k] for k in (0, 2, 1)]
    usual = assessed(follow(motor, with_a_fault(usual_plant)))
    other = assessed(follow(motor, with_a_fault(mirrored)))
    assert usual.change is not None
    assert other.change is not None
    assert other.change.level.value == pytest.approx(usual.change.level.value, rel=0.05)
    expected = {0: 2 if connection is Connection.DELTA else 0}
    assert other.change.level.winding == expected[usual.change.level.winding]


def test_a_motor_that_reverses_has_a_reference_for_each_direction() -> None:
    motor = motor_of()
    forwards, backwards = Plant(), Plant(sequence=PhaseSequence.ACB, seed=5)
    follower = Follower(motor)
    for k in range(120):
        plant = forwards if k % 7 < 4 else backwards
        plant.time_ns = k * HOUR_NS
        follower.fold(plant.record())
        assert assessed(follower).change is None
    forwards.level = 0.01
    for k in range(120, 140):
        plant = forwards if k % 7 < 4 else backwards
        plant.time_ns = k * HOUR_NS
        follower.fold(plant.record())
    # The fault is seen forwards, and stays seen in records backwards.
    assert assessed(follower).change is not None
    assert Follower.restore(motor, follower.save()).save() == follower.save()


def test_edited_parameters_raise_no_alarm() -> None:
    motor, plant = motor_of(), Plant()
    follower = follow(motor, plant.records(60))
    edited = replace(motor, parameters=replace(motor.parameters, stator_leakage_H=0.036))
    follower.apply(Event(plant.time_ns, EventKind.PARAMETERS_EDITED), edited)
    follower = Follower.restore(edited, follower.save())
    for record in plant.records(60):
        follower.fold(record)
    assert assessed(follower).change is None
    assert assessed(follower).reference.records == 120


@pytest.mark.parametrize(
    "kind", [EventKind.RECORDER_CHANGED, EventKind.MAINTENANCE, EventKind.REFERENCE_RESTARTED]
)
def test_an_event_closes_a_change_and_the_reference_is_learnt_anew(kind: EventKind) -> None:
    plant = Plant()
    follower = follow(motor_of(), plant.records(40))
    plant.voltage[1] *= 1.02
    for record in plant.records(10):
        follower.fold(record)
    assert assessed(follower).change is not None
    follower.apply(Event(plant.time_ns, kind, "seen to"))
    for record in plant.records(30):
        follower.fold(record)
    assessment = assessed(follower)
    assert assessment.change is None
    assert assessment.reference.records == 30
    assert assessment.reference.accepted == (kind is EventKind.REFERENCE_RESTARTED)


@pytest.mark.parametrize("level", [0.0, 0.03])
def test_a_motor_that_is_declared_healthy_keeps_what_speaks_against_it(level: float) -> None:
    motor, plant = motor_of(), Plant()
    follower = follow(motor, plant.records(60))
    plant.level = level
    for record in plant.records(20):
        follower.fold(record)
    before = condition_of(motor, assessed(follower), plant.time_ns)
    follower.apply(Event(plant.time_ns, EventKind.REFERENCE_RESTARTED, "surge test passed"))
    for record in plant.records(12):
        follower.fold(record)
    follower = Follower.restore(motor, follower.save())
    after = condition_of(motor, assessed(follower), plant.time_ns)
    assert (after.state, after.mu_f) == (State.HEALTHY, 0.0)
    assert after.reference is not None
    assert after.mu_f_ci95 is not None
    assert after.mu_f_ci95[1] > level, "the interval holds what a person took for healthy"
    declared = after.reference.declared
    if level == 0.0:
        assert declared is None
        return
    assert declared is not None
    assert (declared.level, declared.ci95, declared.phase) == (before.mu_f, before.mu_f_ci95, "a")
    assert any(f"{100.0 * declared.level:.2f} %" in reason for reason in after.reasons)


@pytest.mark.parametrize("after", [8, 60, 200])
def test_maintenance_that_mends_no_winding_takes_no_fault_back(after: int) -> None:
    motor, plant = motor_of(), Plant()
    follower = follow(motor, plant.records(60))
    plant.level = 0.02
    for record in plant.records(after):
        follower.fold(record)
    assert condition_of(motor, assessed(follower), plant.time_ns).state is State.FAULT
    follower.apply(Event(plant.time_ns, EventKind.MAINTENANCE, "bearings greased"))
    for record in plant.records(20):
        told = condition_of(motor, assessed(follower), plant.time_ns)
        assert (told.state, told.phase) == (State.FAULT, "a")
        assert told.change == pytest.approx(plant.level, rel=0.3)
        follower.fold(record)


def test_maintenance_that_mends_a_winding_leaves_nothing() -> None:
    motor, plant = motor_of(), Plant()
    follower = follow(motor, plant.records(60))
    plant.level = 0.02
    for record in plant.records(30):
        follower.fold(record)
    plant.level = 0.0
    follower.apply(Event(plant.time_ns, EventKind.MAINTENANCE, "coil replaced"))
    assert Follower.restore(motor, follower.save()).assessment() == follower.assessment()
    for record in plant.records(8):
        follower.fold(record)
    assert assessed(follower).change is None
    assert condition_of(motor, assessed(follower), plant.time_ns).state is State.HEALTHY


@pytest.mark.parametrize("after", [8, 60])
def test_maintenance_that_mends_a_joint_leaves_nothing(after: int) -> None:
    motor, plant = motor_of(), Plant(load=(0.7, 0.75))
    follower = follow(motor, plant.records(60))
    plant.joint_ohm = 1.0
    for record in plant.records(after):
        follower.fold(record)
    change = assessed(follower).change
    assert change is not None
    assert Kind.CONNECTION in change.named
    plant.joint_ohm = 0.0
    follower.apply(Event(plant.time_ns, EventKind.MAINTENANCE, "terminals tightened"))
    for record in plant.records(8):  # until it is certain that what may be shorted turns, too, has vanished
        follower.fold(record)
    for record in plant.records(32):
        follower.fold(record)
        assert assessed(follower).change is None
    assert condition_of(motor, assessed(follower), plant.time_ns).state is State.HEALTHY


def test_two_events_without_a_record_between_them_forget_no_more_than_one() -> None:
    def saved(kinds: list[EventKind]) -> bytes:
        plant = Plant()
        follower = follow(motor_of(), plant.records(60))
        for kind in kinds:
            follower.apply(Event(plant.time_ns, kind, "seen to"))
        for record in plant.records(12):
            follower.fold(record)
        return follower.save()

    once = saved([EventKind.RECORDER_CHANGED])
    assert saved([EventKind.RECORDER_CHANGED, EventKind.MAINTENANCE]) == once


@pytest.mark.parametrize("kind", [EventKind.RECORDER_CHANGED, EventKind.MAINTENANCE])
@pytest.mark.parametrize("supply_swing", [0.0, 0.003])
def test_a_fault_that_stands_is_seen_again_after_an_event(kind: EventKind, supply_swing: float) -> None:
    """The impedance that was learnt beside it does not explain it away."""
    motor, plant = motor_of(), Plant(level=0.1, path=0.5, unbalance=0.003 + 0.002j, supply_swing=supply_swing)
    follower = follow(motor, plant.records(60))
    assert assessed(follower).standing_fault
    follower.apply(Event(plant.time_ns, kind, "terminals cleaned"))
    for record in plant.records(4):
        follower.fold(record)
    again = condition_of(motor, assessed(follower), plant.time_ns)
    assert again.state is State.FAULT
    assert again.mu_f_ci95 is not None
    assert again.mu_f_ci95[0] < plant.level < again.mu_f_ci95[1]


def test_another_recorder_begins_a_reference_without_being_told() -> None:
    plant = Plant()
    follower = follow(motor_of(), plant.records(40))
    plant.voltage[1] *= 1.01
    for record in plant.records(20):
        follower.fold(replace(record, recorder="another relay"))
    assert assessed(follower).change is None
    assert assessed(follower).reference.records == 20


def test_a_note_resets_nothing() -> None:
    plant = Plant()
    follower = follow(motor_of(), plant.records(20))
    before = follower.save()
    follower.apply(Event(plant.time_ns, EventKind.NOTE, "greased"))
    assert follower.save() == before


def test_a_rewound_motor_begins_at_nothing() -> None:
    follower = follow(motor_of(), Plant().records(20))
    follower.apply(Event(0, EventKind.REWOUND))
    assert follower.assessment() is None


def test_a_motor_that_stands_still_is_refused() -> None:
    record = Plant().record()
    follower = Follower(motor_of())
    with pytest.raises(ValueError, match="positive_voltage_V"):
        follower.fold(replace(record, positive_voltage_V=0j))
    with pytest.raises(ValueError, match="positive_current_A"):
        follower.fold(replace(record, positive_current_A=0j))
    assert follower.assessment() is None


def test_what_would_be_seen_is_seen() -> None:
    plant = Plant(path=0.0)
    follower = follow(motor_of(), plant.records(60))
    detectable = assessed(follower).reference.detectable
    assert detectable is not None
    assert detectable < 0.005
    plant.level = 1.2 * detectable
    for record in plant.records(10):
        follower.fold(record)
    assert assessed(follower).change is not None


def test_nine_of_ten_steps_of_what_would_be_seen_in_noise_are_seen() -> None:
    def is_seen(seed: int) -> bool:
        plant = Plant(path=0.0, noise=2e-3, seed=seed)
        follower = follow(motor_of(), plant.records(60))
        detectable = assessed(follower).reference.detectable
        assert detectable is not None
        plant.level = detectable
        for record in plant.records(10):
            follower.fold(record)
        return assessed(follower).change is not None

    assert sum(is_seen(seed) for seed in range(20)) >= 16


def test_ten_years_of_records_leave_the_covariance_sound() -> None:
    plant = Plant()
    records = plant.records(50)
    follower = Follower(motor_of())
    for k in range(4000):
        follower.fold(replace(records[k % 50], time_ns=k * HOUR_NS))
    state = Follower.restore(motor_of(), follower.save()).save()
    assert state == follower.save()
    standing = assessed(follower).reference.standing
    assert 0.0 < standing.deviation < 0.02


def test_a_record_of_another_recorder_takes_no_fault_back() -> None:
    plant = Plant()
    follower = follow(motor_of(), with_a_fault(plant))
    before = assessed(follower)
    assert before.change is not None
    follower.fold(replace(plant.record(), recorder="uploaded by hand"))
    after = assessed(follower)
    assert after.change == before.change
    assert after.as_of_ns == plant.time_ns
    assert after.seen_by == "relay (abc)"
    reasons = condition_of(motor_of(), after, plant.time_ns).reasons
    assert any("another recorder" in reason for reason in reasons)
    follower.apply(Event(plant.time_ns, EventKind.REWOUND, "one coil"))
    follower.fold(plant.record())
    assert assessed(follower).change is None


def test_two_recorders_in_turn_complete_their_references_and_see_a_fault() -> None:
    plant, follower = Plant(), Follower(motor_of())
    for k in range(100):
        if k == 70:
            plant.level = 0.01
        follower.fold(replace(plant.record(), recorder=f"relay {k % 2}"))
        if k == 69:
            assert assessed(follower).reference.records == 35
            assert assessed(follower).change is None
    states = []
    for k in range(100, 106):
        follower.fold(replace(plant.record(), recorder=f"relay {k % 2}"))
        states.append(condition_of(motor_of(), follower.assessment(), plant.time_ns).state)
    assert set(states) == {State.FAULT}
    assert Follower.restore(motor_of(), follower.save()).save() == follower.save()
    assert len(follower.save()) < 75_000


def test_many_recorders_drop_no_reference_that_tells_a_fault() -> None:
    plant = Plant()
    follower = follow(motor_of(), with_a_fault(plant))
    for k in range(12):
        follower.fold(replace(plant.record(), recorder=f"upload {k}"))
    assert assessed(follower).change is not None
    assert len(follower.save()) < 3 * MOST_BYTES


def test_a_damaged_state_is_refused() -> None:
    state = follow(motor_of(), Plant().records(12)).save()
    with pytest.raises(ValueError, match="fold the records again"):
        Follower.restore(motor_of(), state[:-40] + bytes(40))
