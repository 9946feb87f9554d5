"""Shorted turns that are there no more: repaired, or a contact that comes and goes."""

import numpy as np
import pytest

from core.condition.assessment import Change, Level
from core.condition.changes.vanishing import LONGEST, Vanishing
from core.condition.events import Event, EventKind
from core.condition.filter.state import FILTER
from core.condition.following.follower import Follower
from core.condition.kinds import Kind, State
from core.condition.verdict.condition import Condition
from core.condition.verdict.judging import condition_of
from tests.core.condition.simulated import Plant, follow, motor_of


def told(follower: Follower, plant: Plant, count: int) -> list[Condition]:
    """Fold so many records; return what is told after each."""
    found = []
    for record in plant.records(count):
        follower.fold(record)
        found.append(condition_of(follower.motor, follower.assessment(), record.time_ns))
    return found


def with_fault(plant: Plant, records: int) -> Follower:
    """A motor with 1 % of shorted turns after 60 records, for so many."""
    follower = follow(motor_of(), plant.records(60))
    plant.level = 0.01
    assert told(follower, plant, records)[-1].state is State.FAULT
    plant.level = 0.0
    return follower


@pytest.mark.parametrize("records", [20, 100, pytest.param(300, marks=pytest.mark.campaign)])
def test_a_repaired_fault_is_told_as_gone_once(records: int) -> None:
    plant = Plant(seed=3)
    follower = with_fault(plant, records)
    last_ns = plant.time_ns
    found = told(follower, plant, 100)
    states = [one.state for one in found]
    turned = states.index(State.WATCH)
    assert 2 <= turned <= 8
    assert states == [State.FAULT] * turned + [State.WATCH] * (100 - turned)
    gone = found[-1]
    assert gone.phase == "a"
    assert (gone.change, gone.change_ci95, gone.size) == (0.0, None, None)
    assert gone.mu_f == pytest.approx(0.0, abs=1e-3)
    assert "gone; was it repaired?" in gone.reasons[0]
    assert "0.9" in gone.reasons[1]
    assert "Ask whether" in gone.advice
    assessment = Follower.restore(follower.motor, follower.save()).assessment()
    assert assessment is not None
    assert assessment.change is not None
    assert assessment.change.until_ns == last_ns
    assert assessment.statistic < 5.0, "the reference is that of before the fault"


def test_one_odd_record_takes_no_fault_back() -> None:
    plant = Plant(seed=3)
    follower = with_fault(plant, 40)
    odd, plant.level = told(follower, plant, 2)[-1], 0.01
    assert odd.state is State.FAULT
    assert odd.mu_f == pytest.approx(0.01, rel=0.1)
    assert all(one.state is State.FAULT for one in told(follower, plant, 20))


def test_a_fault_that_comes_back_is_a_fault_again() -> None:
    plant = Plant(seed=3)
    follower = with_fault(plant, 40)
    assert told(follower, plant, 20)[-1].state is State.WATCH
    plant.level = 0.01
    again = told(follower, plant, 12)[-1]
    assert (again.state, again.phase) == (State.FAULT, "a")
    assert again.mu_f == pytest.approx(0.01, rel=0.2)


@pytest.mark.parametrize("kind", [EventKind.MAINTENANCE, EventKind.REFERENCE_RESTARTED])
def test_a_note_ends_what_is_gone(kind: EventKind) -> None:
    plant = Plant(seed=3)
    follower = with_fault(plant, 40)
    assert told(follower, plant, 20)[-1].kind is Kind.SHORTED_TURNS
    follower.apply(Event(plant.time_ns, kind, "coil replaced"))
    assert told(follower, plant, 20)[-1].state is State.HEALTHY


def test_what_is_gone_stays_told_beside_another_change_that_is_lived_with() -> None:
    plant = Plant(seed=3)
    follower = with_fault(plant, 40)
    told(follower, plant, 20)
    plant.voltage[2] *= 1.03
    found = told(follower, plant, 90)
    assert found[30].kind is Kind.VOLTAGE_CHANNEL
    assert "gone" in found[-1].reasons[0]
    assert all(one.state is State.WATCH for one in found)


def test_what_has_only_become_smaller_is_not_gone() -> None:
    plant = Plant(seed=3)
    follower = with_fault(plant, 40)
    plant.level = 0.0045
    smaller = told(follower, plant, LONGEST + 40)[-1]
    assert not any("gone" in reason for reason in smaller.reasons)
    assert smaller.mu_f == pytest.approx(0.0045, rel=0.3)


def test_a_record_counts_for_both_as_its_distance_tells() -> None:
    level = Level(0.01, 0.001, 0)
    change = Change(0, 0, {}, (Kind.SHORTED_TURNS,), level, None, None)
    state = np.zeros(1, FILTER).view(np.recarray)[0]
    state.R = 1e-8
    one = Vanishing.of(change, 0.01 + 0j, [0.0] * 7, 0)
    for time_ns in (1, 2, 3):
        one.look(state, 0.0, 0.5, time_ns)
        assert one.is_open
        assert not one.is_certain
    one.look(state, 0.0, 0.5, 4)
    assert one.is_certain
    assert one.last_ns == 0
    for time_ns in range(5, 10):
        one.look(state, 0.01, 0.5, time_ns)
    assert (one.evidence, one.is_open, one.last_ns) == (0.0, False, 9)
    # Another change that takes the turns' part off and adds across it hides them: nothing has vanished.
    for time_ns in range(10, 20):
        one.look(state, 0.009j, 0.5, time_ns)
    assert not one.is_open
    assert not one.is_certain
