"""Readers that keep their own place find everything that happened, once."""

from core.condition.kinds import State
from service.storage import Repository
from service.storage.states import AlarmEvent, AlarmKind
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.observations import HOUR_NS
from testing.service.plants import NOW_NS


def test_what_happened_to_alarms(repository: Repository) -> None:
    assert repository.latest_alarm_change() == 0
    alarm = repository.raise_alarm("A1_SEL710", AlarmKind.LINK_DOWN, "", "no answer", now_ns=NOW_NS)
    first = repository.latest_alarm_change()
    repository.clear_alarms_of("A1_SEL710", AlarmKind.LINK_DOWN, now_ns=NOW_NS + 1)
    (second,) = repository.alarm_sequences(first, limit=10)
    assert list(repository.alarm_sequences(0, limit=10)) == [first, second]
    assert list(repository.alarm_sequences(0, limit=1)) == [first]
    found = repository.alarm_changes_of([second, first])
    assert [change.event for change, _ in found] == [AlarmEvent.RAISED, AlarmEvent.CLEARED]
    assert {told.id for _, told in found} == {alarm.id}
    assert found[0][1] == repository.alarm(alarm.id)


def test_the_latest_change_of_each_motor(repository: Repository) -> None:
    assert repository.latest_condition_changes() == {}
    tell(repository, HEALTHY)
    tell(repository, FAULT, now_ns=NOW_NS + HOUR_NS)
    latest = repository.condition_history("PUMP-A1", limit=1).items[0]
    assert latest.state is State.FAULT
    assert repository.latest_condition_changes() == {"PUMP-A1": (NOW_NS + HOUR_NS, [latest.id])}
    tell(repository, HEALTHY, now_ns=NOW_NS + HOUR_NS)
    replaced = repository.condition_history("PUMP-A1", limit=1).items[0]
    assert replaced.id != latest.id
    assert repository.latest_condition_changes() == {"PUMP-A1": (NOW_NS + HOUR_NS, [replaced.id])}
