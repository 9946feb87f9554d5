"""A motor has one alarm while its condition is watch or fault."""

from collections.abc import Callable
from dataclasses import replace

import pytest
from sqlalchemy import Engine
from sqlalchemy.orm import Session

from core.condition.kinds import State
from service.storage import Repository
from service.storage.models import MotorRow
from service.storage.records import Alarm
from service.storage.repository.condition_alarms import ConditionInWords, settle_alarm
from service.storage.states import AlarmKind
from testing.service.plants import NOW_NS, two_motor_plant

Settle = Callable[..., None]


@pytest.fixture
def settle(engine: Engine) -> Settle:
    """Note a condition of PUMP-A1."""

    def note(state: State, cause: str = "shorted turns", now_ns: int = NOW_NS) -> None:
        with Session(engine) as session, session.begin():
            motor = session.get_one(MotorRow, "PUMP-A1", with_for_update={"key_share": True})
            words = ConditionInWords(state, cause, f"why {cause}", "test the insulation")
            settle_alarm(session, motor, words, now_ns=now_ns)

    return note


def standing(repository: Repository) -> tuple[Alarm, ...]:
    return repository.alarms(limit=10, motor="PUMP-A1", standing=True).items


def test_a_healthy_motor_has_no_alarm(repository: Repository, settle: Settle) -> None:
    settle(State.UNKNOWN)
    settle(State.HEALTHY)
    assert repository.alarms(limit=10).items == ()


def test_an_alarm_stays_while_the_state_does_and_tells_the_present_cause(
    repository: Repository, settle: Settle
) -> None:
    settle(State.WATCH, "unclear")
    (first,) = standing(repository)
    settle(State.WATCH, "voltage channel b", NOW_NS + 1)
    (alarm,) = standing(repository)
    assert alarm == replace(first, subject="voltage channel b", reason="why voltage channel b")
    assert (alarm.ied, alarm.motor, alarm.kind) == ("A1_SEL710", "PUMP-A1", AlarmKind.CONDITION_WATCH)
    assert (alarm.raised_ns, alarm.advice) == (NOW_NS, "test the insulation")
    assert repository.counts().alarms == {AlarmKind.CONDITION_WATCH: 1}


def test_a_fault_takes_the_place_of_a_watch_and_ends_when_the_motor_is_well(
    repository: Repository, settle: Settle
) -> None:
    settle(State.WATCH)
    settle(State.FAULT, now_ns=NOW_NS + 1)
    assert [alarm.kind for alarm in standing(repository)] == [AlarmKind.CONDITION_FAULT]
    settle(State.HEALTHY, now_ns=NOW_NS + 2)
    assert standing(repository) == ()
    assert repository.counts().alarms == {}
    fault, watch = repository.alarms(limit=10, motor="PUMP-A1").items
    assert (watch.cleared_ns, fault.raised_ns, fault.cleared_ns) == (NOW_NS + 1, NOW_NS + 1, NOW_NS + 2)


def test_the_alarm_of_a_motor_is_none_of_its_relay(repository: Repository, settle: Settle) -> None:
    settle(State.FAULT)
    assert repository.standing_alarms("A1_SEL710") == ()
    assert len(repository.alarms(limit=10, relay="A1_SEL710", standing=True).items) == 1
    assert repository.alarms(limit=10, motor="FAN-A2").items == ()


def test_a_motor_that_left_the_plant_has_no_alarm(repository: Repository, settle: Settle) -> None:
    settle(State.FAULT)
    plant = two_motor_plant()
    repository.sync_plant(replace(plant, motors=plant.motors[1:]))
    settle(State.FAULT)
    assert standing(repository) == ()


def test_an_alarm_is_counted_where_it_was_raised_when_the_motor_moved_to_another_relay(
    repository: Repository, settle: Settle
) -> None:
    settle(State.FAULT)
    plant = two_motor_plant()
    repository.sync_plant(replace(plant, motors=(replace(plant.motors[0], relay="A2_SEL710"),)))
    settle(State.HEALTHY)
    assert repository.counts().alarms == {}


def test_no_text_is_too_strange_for_an_alarm(repository: Repository, settle: Settle) -> None:
    settle(State.FAULT, "a\0b\ud800" + "x" * 10_000)
    (alarm,) = standing(repository)
    assert alarm.subject.startswith("a\N{REPLACEMENT CHARACTER}b\N{REPLACEMENT CHARACTER}x")
    assert len(alarm.subject) < 5000
