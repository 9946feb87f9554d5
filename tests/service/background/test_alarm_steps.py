"""What happens to alarms by itself, however many there are."""

from threading import Event

import pytest

from service.alarms.kinds import AlarmKind
from service.background.alarm_steps import AlarmSteps
from service.storage import Repository
from service.storage.records import SERVICE
from service.storage.repository.alarms import suppression
from service.storage.states import AlarmState
from testing.service.plants import NOW_NS
from tests.service.fixtures import database_url, engine, repository

__all__ = ["database_url", "engine", "repository"]


@pytest.fixture
def shelved(repository: Repository, monkeypatch: pytest.MonkeyPatch) -> Repository:
    """Seven alarms that are shelved until one time; two of them are dealt with at a time."""
    monkeypatch.setattr(suppression, "AT_A_TIME", 2)
    for number in range(7):
        alarm = repository.raise_alarm(
            "A1_SEL710", AlarmKind.FILE_REFUSED, str(number), "outside", now_ns=NOW_NS
        )
        repository.shelve_alarm(alarm.id, until_ns=NOW_NS + 5, by=SERVICE, now_ns=NOW_NS)
    return repository


def states(repository: Repository) -> set[AlarmState]:
    return {alarm.state for alarm in repository.open_alarms(limit=10).items}


def test_all_shelvings_end_at_their_time_and_none_before(shelved: Repository) -> None:
    steps = AlarmSteps(shelved)
    steps.take(NOW_NS + 4)
    assert states(shelved) == {AlarmState.SHELVED}
    steps.take(NOW_NS + 5)
    assert states(shelved) == {AlarmState.UNACKNOWLEDGED}


def test_a_service_that_stops_does_not_wait_for_all_of_them(shelved: Repository) -> None:
    stopping = Event()
    stopping.set()
    AlarmSteps(shelved, stopping).take(NOW_NS + 5)
    assert states(shelved) == {AlarmState.SHELVED}
