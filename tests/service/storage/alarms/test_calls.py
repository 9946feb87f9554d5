"""Calls of alarms in a time, and what became of each: told the same whatever comes later."""

from dataclasses import replace

import pytest

from service.storage import Repository
from service.storage.records import Actor, AlarmPlace, AlarmSpec, Role
from service.storage.states import AlarmKind, AlarmState
from testing.service.plants import NOW_NS, SECOND_NS

HOUR_NS = 3600 * SECOND_NS
ANN = Actor("ann", "command line", frozenset({Role.OPERATOR}))
PLACE = AlarmPlace(relay="A1_SEL710")
SPEC = AlarmSpec(AlarmKind.FILE_REFUSED, "too long", "EVT.CFF")


@pytest.fixture
def alarm(repository: Repository) -> str:
    """An alarm that calls at 0 h, is acknowledged at 1 h, gone at 2 h, and calls anew at 3 h."""
    found = repository.raise_alarm_at(PLACE, SPEC, now_ns=NOW_NS).id
    repository.acknowledge_alarm(found, by=ANN, now_ns=NOW_NS + HOUR_NS, comment="seen")
    repository.clear_alarms_at(PLACE, AlarmKind.FILE_REFUSED, now_ns=NOW_NS + 2 * HOUR_NS)
    repository.raise_alarm_at(PLACE, SPEC, now_ns=NOW_NS + 3 * HOUR_NS)
    return found


@pytest.mark.parametrize("database_url", ["sqlite", "postgresql"], indirect=True)
def test_each_call_with_what_became_of_it(repository: Repository, alarm: str) -> None:
    first, second = repository.alarm_calls(from_ns=NOW_NS, to_ns=NOW_NS + 4 * HOUR_NS, limit=10)
    assert first.alarm.id == alarm
    assert (first.called_ns, first.acknowledged_ns, first.gone_ns) == (
        NOW_NS,
        NOW_NS + HOUR_NS,
        NOW_NS + 2 * HOUR_NS,
    )
    assert (first.acknowledged_by, first.comment, first.state) == ("ann", "seen", AlarmState.NORMAL)
    assert (second.called_ns, second.acknowledged_ns, second.gone_ns, second.state) == (
        NOW_NS + 3 * HOUR_NS,
        None,
        None,
        AlarmState.UNACKNOWLEDGED,
    )
    assert repository.number_of_alarm_calls(from_ns=NOW_NS, to_ns=NOW_NS + 4 * HOUR_NS) == 2


def test_nothing_of_later_is_told(repository: Repository, alarm: str) -> None:
    (call,) = repository.alarm_calls(from_ns=NOW_NS, to_ns=NOW_NS + HOUR_NS, limit=10)
    assert (call.acknowledged_ns, call.gone_ns, call.state) == (None, None, AlarmState.UNACKNOWLEDGED)


def test_the_end_of_a_time_is_not_part_of_it(repository: Repository, alarm: str) -> None:
    assert repository.alarm_calls(from_ns=NOW_NS + 1, to_ns=NOW_NS + 3 * HOUR_NS, limit=10) == ()
    assert repository.number_of_alarm_calls(from_ns=NOW_NS + 1, to_ns=NOW_NS + 3 * HOUR_NS) == 0


def test_an_alarm_that_comes_back_before_anybody_looked_calls_twice(repository: Repository) -> None:
    repository.raise_alarm_at(PLACE, SPEC, now_ns=NOW_NS)
    repository.clear_alarms_at(PLACE, AlarmKind.FILE_REFUSED, now_ns=NOW_NS + HOUR_NS)
    repository.raise_alarm_at(PLACE, SPEC, now_ns=NOW_NS + 2 * HOUR_NS)
    first, second = repository.alarm_calls(from_ns=NOW_NS, to_ns=NOW_NS + 3 * HOUR_NS, limit=10)
    assert first.alarm.id == second.alarm.id
    assert (first.gone_ns, first.state) == (NOW_NS + HOUR_NS, AlarmState.RETURNED_UNACKNOWLEDGED)
    assert (second.gone_ns, second.state) == (None, AlarmState.UNACKNOWLEDGED)


def test_the_latest_of_many_and_those_of_some_sites(repository: Repository) -> None:
    for number in range(5):
        spec = replace(SPEC, subject=f"EVT{number}")
        repository.raise_alarm_at(PLACE, spec, now_ns=NOW_NS + number)
    told = repository.alarm_calls(from_ns=NOW_NS, to_ns=NOW_NS + HOUR_NS, limit=2)
    assert [call.called_ns for call in told] == [NOW_NS + 3, NOW_NS + 4]
    for sites, number in ((["FACTORY_A"], 5), (["FACTORY_B"], 0)):
        found = repository.alarm_calls(from_ns=NOW_NS, to_ns=NOW_NS + HOUR_NS, limit=9, sites=sites)
        assert len(found) == number
        assert repository.number_of_alarm_calls(from_ns=NOW_NS, to_ns=NOW_NS + HOUR_NS, sites=sites) == number
