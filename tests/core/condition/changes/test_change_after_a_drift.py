"""A channel that drifts, and what comes after it: what is named swallows no fault, also in its own phase."""

import pytest

from core.condition.following.follower import Follower
from core.condition.kinds import Kind, State
from core.condition.verdict.condition import Condition
from core.condition.verdict.judging import condition_of
from tests.core.condition.simulated import Plant, follow, motor_of

BEFORE, DRIFT_RECORDS, WITHIN = 40, 60, 10
DRIFT = 0.012
MOST_BYTES = 60_000


def drifted(plant: Plant, channels: str, size: float, records: int = DRIFT_RECORDS) -> Follower:
    """A follower after healthy records, and a drift of phase a's channel by so much in 60 records."""
    follower = follow(motor_of(), plant.records(BEFORE))
    of_channels = getattr(plant, channels)
    before = of_channels[0]
    for k in range(1, records + 1):
        of_channels[0] = before * (1.0 + size * min(k / DRIFT_RECORDS, 1.0))
        follower.fold(plant.record())
    return follower


def condition(follower: Follower, plant: Plant) -> Condition:
    return condition_of(motor_of(), follower.assessment(), plant.time_ns)


@pytest.mark.parametrize("level", [0.05, 0.02])
@pytest.mark.parametrize("size", [-DRIFT, DRIFT])
@pytest.mark.parametrize("channels", ["voltage", "current"])
@pytest.mark.parametrize("path", [0.0, 3.0])
def test_turns_of_the_phase_whose_channel_has_drifted_are_a_fault(
    channels: str, size: float, level: float, path: float
) -> None:
    plant = Plant(path=path)
    follower = drifted(plant, channels, size)
    assert condition(follower, plant).state is not State.FAULT
    plant.level = level
    for record in plant.records(WITHIN):
        follower.fold(record)
    told = condition(follower, plant)
    assert (told.state, told.phase) == (State.FAULT, "a")
    assert told.mu_f_ci95 is not None
    low, high = told.mu_f_ci95
    assert low < level < high
    assert low > 0.6 * level


@pytest.mark.parametrize("winding", [0, 1, 2])
@pytest.mark.parametrize("records", [25, 45])
def test_turns_that_short_while_a_channel_still_drifts_are_a_fault(records: int, winding: int) -> None:
    plant = Plant()
    follower = drifted(plant, "voltage", DRIFT, records)
    plant.level, plant.winding = 0.02, winding
    for record in plant.records(WITHIN):
        follower.fold(record)
    told = condition(follower, plant)
    assert (told.state, told.phase) == (State.FAULT, "abc"[winding])


@pytest.mark.parametrize("a_record", [-0.0006, 0.0003])
def test_the_size_of_a_drift_is_followed_while_it_is_in_the_standing_errors(a_record: float) -> None:
    plant = Plant()
    follower = follow(motor_of(), plant.records(BEFORE))
    before = plant.voltage[1]
    for k in range(1, 131):
        plant.voltage[1] = before * (1.0 + k * a_record)
        follower.fold(plant.record())
        assessment = follower.assessment()
        assert assessment is not None
        if k < 80 or k % 10:
            continue
        assert assessment.change is not None
        assert assessment.change.named == (Kind.VOLTAGE_CHANNEL,)
        assert assessment.change.size == pytest.approx(k * a_record, rel=0.1)
        assert assessment.change.size_ci95 is not None
        low, high = assessment.change.size_ci95
        assert low < k * a_record < high


def test_what_is_named_is_never_unlikely() -> None:
    plant = Plant()
    follower = drifted(plant, "voltage", DRIFT)
    plant.level = 0.02
    for record in plant.records(40):
        follower.fold(record)
        assessment = follower.assessment()
        assert assessment is not None
        change = assessment.change
        assert change is not None
        if change.named:
            assert sum(change.probabilities[kind] for kind in change.named) > 0.5


def test_a_follower_with_a_second_change_is_restored_bit_by_bit() -> None:
    plant = Plant()
    follower = drifted(plant, "voltage", DRIFT, 45)
    plant.level = 0.02
    for k, record in enumerate(plant.records(WITHIN)):
        state = follower.save()
        assert len(state) < MOST_BYTES
        other = Follower.restore(motor_of(), state)
        assert other.assessment() == follower.assessment(), k
        follower.fold(record)
        other.fold(record)
        assert other.save() == follower.save(), k
    assert condition(follower, plant).state is State.FAULT
