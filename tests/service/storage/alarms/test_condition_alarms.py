"""A motor has one alarm while its condition is watch or fault."""

from collections.abc import Callable
from dataclasses import replace

import pytest
from sqlalchemy import Engine
from sqlalchemy.orm import Session

from core.condition.kinds import Kind
from core.condition.verdict.condition import Condition
from service.storage import Repository
from service.storage.models import MotorRow
from service.storage.records import Alarm
from service.storage.repository.alarms.conditions import settle_alarm
from service.storage.states import AlarmKind
from testing.service.conditions import DRIFTING, FAULT, HEALTHY, UNKNOWN, entry_of, tell
from testing.service.plants import NOW_NS, two_motor_plant

Settle = Callable[..., None]
WATCH = DRIFTING


@pytest.fixture
def settle(engine: Engine) -> Settle:
    """Note a condition of PUMP-A1."""

    def note(condition: Condition, now_ns: int = NOW_NS) -> None:
        with Session(engine) as session, session.begin():
            motor = session.get_one(MotorRow, "PUMP-A1")
            settle_alarm(session, motor, entry_of(condition), now_ns=now_ns)

    return note


def standing(repository: Repository) -> tuple[Alarm, ...]:
    return repository.alarms(limit=10, motor="PUMP-A1", standing=True).items


def test_a_healthy_motor_has_no_alarm(repository: Repository, settle: Settle) -> None:
    settle(UNKNOWN)
    settle(HEALTHY)
    assert repository.alarms(limit=10).items == ()


def test_an_alarm_stays_while_the_state_does_and_tells_the_present_cause(
    repository: Repository, settle: Settle
) -> None:
    settle(WATCH)
    (first,) = standing(repository)
    assert (first.ied, first.motor, first.kind) == ("A1_SEL710", "PUMP-A1", AlarmKind.CONDITION_WATCH)
    assert first.subject == "voltage channel or shorted turns in phase c"
    assert (first.raised_ns, first.reason) == (NOW_NS, "something has changed")
    named = replace(
        WATCH, kind=Kind.VOLTAGE_CHANNEL, candidates=(), reasons=("named", "why"), advice="look at it"
    )
    settle(named, NOW_NS + 1)
    (alarm,) = standing(repository)
    assert alarm == replace(
        first, subject="voltage channel in phase c", reason="named; why", advice="look at it", value=0.004
    )
    assert repository.counts().alarms == {AlarmKind.CONDITION_WATCH: 1}


def test_a_fault_takes_the_place_of_a_watch_and_ends_when_the_motor_is_well(
    repository: Repository, settle: Settle
) -> None:
    settle(WATCH)
    settle(FAULT, now_ns=NOW_NS + 1)
    assert [alarm.kind for alarm in standing(repository)] == [AlarmKind.CONDITION_FAULT]
    settle(HEALTHY, now_ns=NOW_NS + 2)
    assert standing(repository) == ()
    assert repository.counts().alarms == {}
    fault, watch = repository.alarms(limit=10, motor="PUMP-A1").items
    assert (watch.cleared_ns, fault.raised_ns, fault.cleared_ns) == (NOW_NS + 1, NOW_NS + 1, NOW_NS + 2)


def test_the_alarm_of_a_motor_is_none_of_its_relay(repository: Repository, settle: Settle) -> None:
    settle(FAULT)
    assert repository.standing_alarms("A1_SEL710") == ()
    assert len(repository.alarms(limit=10, relay="A1_SEL710", standing=True).items) == 1
    assert repository.alarms(limit=10, motor="FAN-A2").items == ()


def test_a_motor_that_left_the_plant_has_no_alarm_until_it_is_back(repository: Repository) -> None:
    tell(repository, FAULT)
    plant = two_motor_plant()
    repository.sync_plant(replace(plant, motors=plant.motors[1:]))
    repository.settle_alarms(now_ns=NOW_NS + 1)
    assert standing(repository) == ()
    repository.sync_plant(plant)
    for _ in range(2):
        repository.settle_alarms(now_ns=NOW_NS + 2)
    (alarm,) = standing(repository)
    assert (alarm.kind, alarm.raised_ns) == (AlarmKind.CONDITION_FAULT, NOW_NS + 2)


def test_an_alarm_is_counted_where_it_was_raised_when_the_motor_moved_to_another_relay(
    repository: Repository, settle: Settle
) -> None:
    settle(FAULT)
    plant = two_motor_plant()
    repository.sync_plant(replace(plant, motors=(replace(plant.motors[0], relay="A2_SEL710"),)))
    settle(HEALTHY)
    assert repository.counts().alarms == {}


def test_no_text_is_too_strange_for_an_alarm(repository: Repository, settle: Settle) -> None:
    settle(replace(FAULT, reasons=("a\0b\ud800" + "x" * 10_000,)))
    (alarm,) = standing(repository)
    assert alarm.reason.startswith("a\N{REPLACEMENT CHARACTER}b\N{REPLACEMENT CHARACTER}x")
    assert len(alarm.reason) < 5000


def test_the_alarm_comes_with_the_condition(repository: Repository) -> None:
    tell(repository, FAULT)
    (alarm,) = standing(repository)
    assert (alarm.kind, alarm.subject) == (AlarmKind.CONDITION_FAULT, "shorted turns in phase b")
    tell(repository, HEALTHY, now_ns=NOW_NS + 1)
    assert standing(repository) == ()
