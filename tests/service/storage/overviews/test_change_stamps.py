"""Stamps change with what pages show, and the counter with whatever is written, on both databases."""

import time
from collections.abc import Callable

import pytest
from sqlalchemy import Engine

from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.change_counter import ChangeCounter
from service.storage.records import Actor, Role
from service.storage.repository.overviews.change_stamps import Subject
from service.storage.states import AlarmKind, LinkState
from testing.service.conditions import FAULT, tell
from testing.service.following import FAN, PUMP, Recorder
from testing.service.links import set_link_state
from testing.service.observations import observation
from testing.service.plants import NOW_NS

BY = Actor("ann", "here")
RELAY = "A1_SEL710"

ALL = list(Subject)

Change = Callable[[Repository, Recorder], object]


def new_alarm(repository: Repository, _recorder: Recorder) -> None:
    repository.raise_alarm(RELAY, AlarmKind.CLOCK_OFF, "", "2 s", now_ns=NOW_NS)


def link_goes_down(repository: Repository, _recorder: Recorder) -> None:
    set_link_state(repository, RELAY, LinkState.DOWN, "timed out", now_ns=NOW_NS)


def condition_is_told(repository: Repository, _recorder: Recorder) -> None:
    tell(repository, FAULT)


def recording_comes(_repository: Repository, recorder: Recorder) -> None:
    recorder.record(observation(0))


def user_comes(repository: Repository, _recorder: Recorder) -> None:
    repository.add_user("kim", [Role.VIEWER], password=None, by=BY, now_ns=time.time_ns())


CHANGES: list[tuple[Change, set[Subject], set[str]]] = [
    (new_alarm, {Subject.FLEET, Subject.ALARMS}, set()),
    (link_goes_down, {Subject.FLEET, Subject.RELAYS}, {PUMP}),
    (condition_is_told, {Subject.FLEET, Subject.ALARMS}, {PUMP}),
    (recording_comes, {Subject.RELAYS, Subject.RECORDINGS}, {PUMP}),
    (user_comes, {Subject.PEOPLE}, set()),
]


@pytest.fixture
def recorder(repository: Repository, store: RecordingStore) -> Recorder:
    return Recorder(repository, store)


@pytest.mark.parametrize(("change", "subjects", "motors"), CHANGES)
def test_a_stamp_changes_with_what_its_pages_show(
    repository: Repository, recorder: Recorder, change: Change, subjects: set[Subject], motors: set[str]
) -> None:
    before = repository.change_stamps(ALL), repository.motor_stamps([PUMP, FAN])
    assert (repository.change_stamps(ALL), repository.motor_stamps([PUMP, FAN])) == before
    change(repository, recorder)
    after = repository.change_stamps(ALL), repository.motor_stamps([PUMP, FAN])
    assert {subject for subject in Subject if after[0][subject] != before[0][subject]} == subjects
    assert {motor for motor in (PUMP, FAN) if after[1][motor] != before[1][motor]} == motors


def test_a_motor_that_there_is_not_has_a_stamp(repository: Repository) -> None:
    stamps = repository.motor_stamps(["NOBODY", PUMP])
    assert set(stamps) == {"NOBODY", PUMP}
    assert repository.motor_stamps(["NOBODY"])["NOBODY"] == stamps["NOBODY"]


@pytest.fixture
def counter(repository: Repository) -> ChangeCounter:
    return repository.change_counter()


def test_the_counter_changes_with_what_others_write(
    repository: Repository, engine: Engine, counter: ChangeCounter
) -> None:
    before = counter.value()
    repository.change_stamps(ALL)
    assert counter.value() == before
    set_link_state(repository, RELAY, LinkState.DOWN, "timed out", now_ns=NOW_NS)
    after = counter.value()
    assert after != before
    assert counter.value() == after
    counter.close()
    assert counter.value() != after, "another connection may have missed what came between"
    counter.close()
