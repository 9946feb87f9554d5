"""Motors that other rules have judged are judged again, behind new records."""

from concurrent.futures import Future
from dataclasses import replace
from itertools import permutations

import pytest

from core.units import NANOSECONDS_PER_DAY
from service.condition import folding, work
from service.condition.folding import fold
from service.condition.work import ConditionWork
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Backlog
from testing.service.following import FAN, PUMP, Recorder, fold_all
from testing.service.plants import NOW_NS, motor, two_motor_plant
from tests.service.condition.tasks import MOTORS, RECORDS, failed


def other_rules(monkeypatch: pytest.MonkeyPatch, rules: str) -> None:
    for module in (work, folding):
        monkeypatch.setattr(module, "RULES", rules)


def one_part(conditions: ConditionWork, repository: Repository, records: int) -> str:
    """Have the next task fold one part of its motor; return the motor."""
    task = conditions.next_task()
    assert task is not None
    due = repository.begin_fold(task.motor, records)
    assert due is not None
    assert repository.finish_fold(due, fold(due, motor(task.motor)), now_ns=NOW_NS)
    future: Future[int] = Future()
    future.set_result(len(due.observations))
    conditions.ended(task, future)
    return task.motor


def test_motors_that_other_rules_judged_are_judged_again_in_the_background(
    repository: Repository, store: RecordingStore, database_url: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A service killed between two parts goes on; one with other rules begins from the first record."""
    Recorder(repository, store).record_all(RECORDS[:12])
    fold_all(repository)
    before = repository.condition(PUMP)

    def started() -> ConditionWork:
        conditions = ConditionWork(repository, MOTORS, database_url=database_url)
        conditions.begin()
        return conditions

    assert started().next_task() is None, "the same rules"
    other_rules(monkeypatch, "another")
    assert one_part(started(), repository, 5) == PUMP
    assert repository.condition(PUMP) == replace(before, version=before.version + 1), (
        "as it was until the end"
    )
    conditions = started()
    assert repository.earliest_marks() == {PUMP: RECORDS[5].time_ns}, "what was done is not lost"
    other_rules(monkeypatch, "a third")
    conditions = started()
    parts = 0
    while repository.motors_to_fold():
        parts += 1
        one_part(conditions, repository, 5)
    while conditions.next_task() is not None:
        conditions.give_back()
        parts += 1
        one_part(conditions, repository, 5)
    assert parts == 2 + 3, "the rest of it by rules of before, then all of it"
    assert repository.condition(PUMP).document == before.document
    assert started().next_task() is None


def test_new_records_come_before_motors_that_are_judged_again(
    repository: Repository, store: RecordingStore, database_url: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    names = (FAN, PUMP, "ZZ-NEW")
    motors = {name: motor(name) for name in names}
    plant = two_motor_plant()
    (known, *_) = plant.motors
    repository.sync_plant(replace(plant, motors=(*plant.motors, replace(known, motor=motors[names[2]]))))
    recorder = Recorder(repository, store)
    spread = [replace(one, time_ns=NOW_NS + at * 3 * NANOSECONDS_PER_DAY) for at, one in enumerate(RECORDS)]
    for name in names:
        recorder.record_all(spread[:10], name)
    fold_all(repository, motors[names[2]])
    other_rules(monkeypatch, "another")
    conditions = ConditionWork(repository, motors, database_url=database_url)
    conditions.begin()
    assert repository.motors_to_fold() == ()
    task = conditions.next_task()
    assert task is not None
    conditions.ended(task, failed(RuntimeError("a bug")))
    assert conditions.next_task() is None, "no other one begins while this one waits to be tried again"
    conditions = ConditionWork(repository, motors, database_url=database_url)
    conditions.begin()
    assert not repository.judge_anew(FAN, "another"), "it has its mark"
    given = [one_part(conditions, repository, 4) for _ in range(2)]
    assert given == [FAN, FAN], "one after the other"
    recorder.record(spread[10], PUMP)
    recorder.record(spread[10], names[2])
    given = [one_part(conditions, repository, 4) for _ in range(2)]
    assert sorted(given) == [PUMP, names[2]]
    assert repository.condition(PUMP).as_of_ns == spread[10].time_ns
    assert repository.motors_to_fold() == (FAN,)
    for one in (PUMP, names[2]):
        repository.forget_checkpoints(one)
    first, *others = [one_part(conditions, repository, 4) for _ in range(7)]
    assert first == FAN, "it is further than those that begin from the first record on"
    assert [others[:3], others[3:]] in ([[one] * 3, [two] * 3] for one, two in permutations(names[1:]))
    assert conditions.next_task() is None, "those with other checkpoints have been judged again already"


def test_a_motor_out_of_service_is_judged_again_when_it_is_back(
    repository: Repository, store: RecordingStore, database_url: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    recorder = Recorder(repository, store)
    (left_out, *_) = recorder.record_all(RECORDS[:3])
    fold_all(repository)
    repository.leave_out(left_out, "it failed", "an older program")
    repository.set_fold_aside(PUMP, repository.fold_marks(PUMP), "it failed too")
    plant = two_motor_plant()
    without = tuple(one for one in plant.motors if one.name != PUMP)
    other_rules(monkeypatch, "another")
    conditions = ConditionWork(repository, MOTORS, database_url=database_url)
    repository.sync_plant(replace(plant, motors=without))
    conditions.begin()
    assert conditions.next_task() is None
    assert repository.backlog() == Backlog(0)
    repository.sync_plant(plant)
    conditions.begin()
    while conditions.next_task() is not None:
        conditions.give_back()
        one_part(conditions, repository, 4)
    assert len(repository.condition_trend(PUMP, limit=9).items) == 3
    assert repository.motors_judged_by_other_rules("another") == ()
