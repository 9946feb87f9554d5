"""What has not been told yet is read from the database in order, whenever it was committed or recorded."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from service.gateways.kept_file import KeptFileError
from service.gateways.mqtt.history import PAGE, History
from service.gateways.mqtt.kept_topics import TOPICS, KeptTopics
from service.gateways.mqtt.position import POSITION, WINDOW, Place, Position
from service.storage import Repository
from service.storage.states import AlarmKind
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.plants import NOW_NS


@pytest.fixture
def position(tmp_path: Path) -> Position:
    return Position(tmp_path)


@pytest.fixture
def history(repository: Repository, position: Position) -> History:
    history = History(repository, "statorwatch")
    history.begin(position)
    return history


def raise_many(repository: Repository, number: int) -> None:
    for one in range(number // 2):
        repository.raise_alarm("A1_SEL710", AlarmKind.LINK_DOWN, "", "no answer", now_ns=NOW_NS + 2 * one)
        repository.clear_alarms_of("A1_SEL710", AlarmKind.LINK_DOWN, now_ns=NOW_NS + 2 * one + 1)


def told_alarms(history: History, position: Position) -> list[int]:
    """The numbers of all changes of alarms that are told, a page at a time."""
    told: list[int] = []
    while (telling := history.alarms(position)) is not None:
        assert len(telling.messages) <= PAGE
        told += [json.loads(message.payload)["sequence"] for message in telling.messages]
        telling.note(position)
        position.save()
    return told


def told_states(history: History, position: Position) -> list[str]:
    told: list[str] = []
    for telling in history.conditions(position):
        told += [json.loads(message.payload)["state"] for message in telling.messages]
        telling.note(position)
    return told


def test_more_than_a_page_is_told_in_order_and_once(
    repository: Repository, history: History, position: Position, tmp_path: Path
) -> None:
    raise_many(repository, 2 * PAGE + 50)
    expected = list(repository.alarm_sequences(0, limit=10 * PAGE))
    assert told_alarms(history, position) == expected
    assert told_alarms(history, Position(tmp_path)) == []


def test_a_change_that_was_committed_after_a_later_one_is_told(
    repository: Repository, history: History, position: Position
) -> None:
    raise_many(repository, 20)
    numbers = repository.alarm_sequences(0, limit=100)
    position.told([number for number in numbers if number != numbers[-5]])
    assert told_alarms(history, position) == [numbers[-5]]


def test_what_happened_before_the_first_start_is_not_told(repository: Repository, tmp_path: Path) -> None:
    raise_many(repository, WINDOW + 20)
    tell(repository, FAULT)
    position, history = Position(tmp_path), History(repository, "statorwatch")
    history.begin(position)
    assert told_alarms(history, position) == []
    assert told_states(history, position) == []
    assert not Position(tmp_path).is_new


def test_a_record_that_comes_late_has_its_last_word_told(
    repository: Repository, history: History, position: Position
) -> None:
    for number in range(3):
        condition = FAULT if number % 2 == 0 else HEALTHY
        tell(repository, replace(condition, as_of_ns=NOW_NS + number), now_ns=NOW_NS + number)
    assert told_states(history, position) == ["fault", "healthy", "fault"]
    assert told_states(history, position) == []
    # As if a fold had taken the latest change away: what was told is later than all there is.
    position.conditions["PUMP-A1"] = Place(NOW_NS + 5, ("gone",))
    assert told_states(history, position) == ["fault"]
    assert told_states(history, position) == []


def test_changes_of_the_same_time_are_all_told(
    repository: Repository, history: History, position: Position
) -> None:
    expected = [FAULT, HEALTHY] * 4
    told = []
    for condition in expected:
        tell(repository, condition)
        told += told_states(history, position)
    assert told == [condition.state for condition in expected]


@pytest.mark.parametrize(
    "text",
    [
        "[]",
        "{",
        '{"alarms": [true], "conditions": {}}',
        '{"alarms": [], "conditions": {"A": [1, "x"]}}',
        "{}",
    ],
)
def test_a_position_that_is_something_else_is_told(tmp_path: Path, text: str) -> None:
    (tmp_path / POSITION).write_text(text, encoding="utf-8")
    with pytest.raises(KeptFileError, match="expected"):
        Position(tmp_path)


def test_topics_are_noted_and_forgotten(tmp_path: Path) -> None:
    KeptTopics(tmp_path).add({"a", "b"})
    assert KeptTopics(tmp_path).gone({"b", "c"}) == ["a"]
    KeptTopics(tmp_path).forget(["a"])
    assert KeptTopics(tmp_path).gone(()) == ["b"]
    (tmp_path / TOPICS).write_text('{"topics": [1]}', encoding="utf-8")
    with pytest.raises(KeptFileError, match="expected topics"):
        KeptTopics(tmp_path)
