"""A second change after a first one was named: it is seen, and takes nothing back that is a fault."""

from dataclasses import dataclass

import pytest

from core.condition.changes.alarm import KINDS, Alarm, Weighing, confirm
from core.condition.following.follower import Follower
from core.condition.kinds import Kind, State
from core.condition.verdict.condition import Condition
from core.condition.verdict.judging import condition_of
from tests.core.condition.simulated import Plant, motor_of

BEFORE, BETWEEN = 60, 80
CHANGING_LOAD = (0.2, 1.0)
SEEDS = [0, pytest.param(1, marks=pytest.mark.campaign), pytest.param(2, marks=pytest.mark.campaign)]


@dataclass
class Course:
    """A motor that is followed through its changes."""

    plant: Plant

    def __post_init__(self) -> None:
        self.motor = motor_of()
        self.follower = Follower(self.motor)
        self.records(BEFORE)

    def records(self, count: int) -> Condition:
        """Fold so many records; return what is told after the last."""
        for record in self.plant.records(count):
            self.follower.fold(record)
        return self.condition

    @property
    def condition(self) -> Condition:
        """What is told now."""
        return condition_of(self.motor, self.follower.assessment(), self.plant.time_ns)


@pytest.mark.parametrize("winding", [0, 1])
def test_shorted_turns_after_a_joint_are_a_fault_in_their_phase(winding: int) -> None:
    course = Course(Plant(load=CHANGING_LOAD))
    course.plant.joint_ohm, course.plant.joint = 2.0, 1
    joint = course.records(BETWEEN)
    assert (joint.state, joint.kind, joint.phase) == (State.WATCH, Kind.CONNECTION, "b")
    course.plant.level, course.plant.winding = 0.015, winding
    fault = course.records(12)
    assert (fault.state, fault.phase) == (State.FAULT, "ab"[winding])
    assert fault.mu_f == pytest.approx(0.015, abs=0.002)


@pytest.mark.parametrize("channels", ["voltage", "current"])
def test_shorted_turns_after_a_channel_s_error_are_a_fault(channels: str) -> None:
    course = Course(Plant())
    getattr(course.plant, channels)[2] *= 1.03
    channel = course.records(BETWEEN)
    assert (channel.state, channel.phase) == (State.WATCH, "c")
    course.plant.level = 0.01
    fault = course.records(12)
    assert (fault.state, fault.phase) == (State.FAULT, "a")
    assert fault.mu_f == pytest.approx(0.01, abs=0.002)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("levels", [(0.01, 0.02), (0.003, 0.015), (0.006, 0.03)])
@pytest.mark.parametrize("between", [20, BETWEEN])
def test_a_second_step_of_a_fault_stays_a_fault_and_its_level_follows(
    seed: int, levels: tuple[float, float], between: int
) -> None:
    course = Course(Plant(seed=seed))
    course.plant.level = levels[0]
    course.records(between)
    course.plant.level = levels[1]
    course.records(10)
    for _ in range(12):
        told = course.records(10)
        assert told.state is State.FAULT
        assert told.phase == "a"
        assert told.mu_f is not None
        assert 0.6 * levels[1] < told.mu_f < 1.2 * levels[1]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("first", [0.003, 0.01])
def test_a_second_fault_in_another_phase_is_told_if_it_is_the_worse_one(seed: int, first: float) -> None:
    course = Course(Plant(seed=seed))
    course.plant.level, course.plant.winding = first, 0
    course.records(BETWEEN)
    course.plant.level, course.plant.winding = 0.02, 1
    course.records(10)
    for _ in range(6):
        told = course.records(10)
        assert (told.state, told.phase) == (State.FAULT, "b")
        assert told.mu_f == pytest.approx(0.02, rel=0.4)


@pytest.mark.parametrize("channels", ["voltage", "current"])
@pytest.mark.parametrize("size", [-0.015, 0.015])
def test_a_channel_s_error_after_shorted_turns_takes_the_fault_not_back(channels: str, size: float) -> None:
    course = Course(Plant())
    course.plant.level = 0.01
    course.records(BETWEEN)
    getattr(course.plant, channels)[2] *= 1.0 + size
    for _ in range(6):
        told = course.records(20)
        assert (told.state, told.phase) == (State.FAULT, "a")


def test_a_second_error_of_a_channel_is_named_in_its_channel() -> None:
    course = Course(Plant())
    course.plant.voltage[2] *= 1.015
    assert course.records(BETWEEN).phase == "c"
    course.plant.voltage[1] *= 0.985
    told = course.records(12)
    assert (told.kind, told.phase) == (Kind.VOLTAGE_CHANNEL, "b")


@pytest.mark.parametrize(
    ("named", "sure", "records", "told"),
    [
        ((Kind.SHORTED_TURNS,), (Kind.PARAMETERS,), 20, (Kind.SHORTED_TURNS,)),
        ((Kind.SHORTED_TURNS,), (Kind.CONNECTION,), 100, (Kind.SHORTED_TURNS,)),
        ((Kind.SHORTED_TURNS,), (Kind.VOLTAGE_CHANNEL,), 100, (Kind.SHORTED_TURNS,)),
        ((Kind.SHORTED_TURNS,), (Kind.VOLTAGE_CHANNEL,), 20, (Kind.VOLTAGE_CHANNEL,)),
        ((Kind.SHORTED_TURNS, Kind.CONNECTION), (Kind.CONNECTION,), 100, (Kind.CONNECTION,)),
        ((Kind.VOLTAGE_CHANNEL,), (Kind.SHORTED_TURNS,), 100, (Kind.SHORTED_TURNS,)),
    ],
)
def test_a_name_that_is_final_takes_no_shorted_turns_back(
    named: tuple[Kind, ...], sure: tuple[Kind, ...], records: int, told: tuple[Kind, ...]
) -> None:
    causes = {kind: cause for cause, kind in KINDS.items()}
    weighing = Weighing()
    for kind in sure:
        weighing.probabilities[causes[kind]] = 0.99 / len(sure)
    alarm = Alarm(0, records=records, named=named)
    for _ in range(3):
        confirm(alarm, weighing)
    assert alarm.named == told


@pytest.mark.parametrize(
    ("records", "looked_at"), [(64, True), (65, False), (72, True), (264, False), (288, True), (3200, True)]
)
def test_a_level_that_grows_long_after_the_alarm_may_still_be_called(records: int, looked_at: bool) -> None:
    assert Alarm(0, records=records, named=(Kind.SHORTED_TURNS,)).may_be_called is looked_at
    assert not Alarm(0, records=records, named=(Kind.VOLTAGE_CHANNEL,)).may_be_called


def test_a_second_change_that_is_gone_leaves_what_stood_before_the_first() -> None:
    course = Course(Plant())
    before = course.follower.assessment()
    course.plant.voltage[2] *= 1.03
    assert course.records(BETWEEN).kind is Kind.VOLTAGE_CHANNEL
    course.plant.level = 0.01
    assert course.records(12).state is State.FAULT
    course.plant.level = 0.0
    after = course.records(40)
    assert before is not None
    assert after.reference is not None
    assert "gone" in after.reasons[0]
    assert after.reference.standing_score == pytest.approx(before.reference.standing_score, abs=0.1)


def test_living_with_a_change_keeps_what_it_leaves_uncertain() -> None:
    """On a supply that hardly changes, the impedance has taken up some of the joint."""
    course = Course(Plant(supply_swing=0.0005, unbalance=0.02))
    course.plant.joint_ohm, course.plant.joint = 3.0, 1
    told = course.records(140)
    assert told.reference is not None
    assert told.reference.detectable is not None
    assert told.reference.detectable > 0.0046, "0.0044 without that"


def test_a_channel_s_error_that_is_lived_with_is_no_standing_fault() -> None:
    course = Course(Plant())
    course.plant.voltage[2] *= 1.05
    assert course.records(BETWEEN).kind is Kind.VOLTAGE_CHANNEL
    told = course.records(60)
    assert (told.state, told.kind) == (State.WATCH, Kind.VOLTAGE_CHANNEL)
    assessment = course.follower.assessment()
    assert assessment is not None
    assert assessment.called_above == 0.0
