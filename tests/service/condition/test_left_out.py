"""Recordings that cannot be folded are left out at last, and tried again later."""

import pickle
from concurrent.futures import Future
from typing import Any

import pytest

from core.condition.following.follower import Follower
from core.condition.observation import Observation
from service.condition import work
from service.condition.errors import RecordFoldError
from service.condition.work import ConditionWork
from service.condition.worker import fold_motor
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.timing.backoff import Backoff
from testing.service.following import FAN, PUMP, Recorder, fold_all
from tests.service.condition.tasks import MOTORS, RECORDS


def test_a_record_that_cannot_be_folded_is_left_out_at_last_and_the_others_count(
    repository: Repository, store: RecordingStore, database_url: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(work, "FAILURES", Backoff(0.0, 0.0))
    recorder = Recorder(repository, store)
    ids = recorder.record_all(RECORDS[:5])
    recorder.record(RECORDS[0], FAN)
    refuse = RECORDS[3].time_ns
    fold = Follower.fold

    def failing(follower: Follower, observation: Observation, *others: Any) -> None:
        if observation.time_ns == refuse:
            raise OverflowError("too large")
        fold(follower, observation, *others)

    monkeypatch.setattr(Follower, "fold", failing)
    conditions = ConditionWork(repository, MOTORS, database_url=database_url)
    tries = 0
    while (task := conditions.next_task()) is not None:
        tries += 1
        assert tries < 10
        future: Future[int] = Future()
        try:
            future.set_result(fold_motor(task.fold))
        except RecordFoldError as error:
            future.set_exception(pickle.loads(pickle.dumps(error)))  # noqa: S301 - as from a worker
        conditions.ended(task, future)
    assert repository.condition(PUMP).as_of_ns == RECORDS[4].time_ns
    assert repository.condition(FAN).as_of_ns == RECORDS[0].time_ns
    points = repository.condition_trend(PUMP, limit=10).items
    assert [point.recording_id for point in points] == [*ids[:3], ids[4]]
    reason = repository.recording(ids[3]).reason
    assert reason is not None
    assert reason.startswith("left out of the condition: OverflowError: too large; it is tried again")

    monkeypatch.setattr(Follower, "fold", fold)
    conditions.begin()
    assert repository.motors_to_fold() == (), "the same program is not tried twice"
    monkeypatch.setattr(work, "PROGRAM", "a mended one")
    conditions.begin()
    fold_all(repository)
    points = repository.condition_trend(PUMP, limit=10).items
    assert [point.recording_id for point in points] == ids, "nothing is lost once the service is mended"
    assert repository.recording(ids[3]).reason is None


def test_another_diagnosis_takes_a_record_in_again_that_was_left_out(
    repository: Repository, store: RecordingStore
) -> None:
    recorder = Recorder(repository, store)
    ids = recorder.record_all(RECORDS[:3])
    fold_all(repository)
    repository.leave_out(ids[1], "left out", "this program")
    fold_all(repository)
    assert [one.recording_id for one in repository.condition_trend(PUMP, limit=9).items] == [ids[0], ids[2]]
    recorder.diagnose_again(ids[1], RECORDS[1])
    fold_all(repository)
    assert [one.recording_id for one in repository.condition_trend(PUMP, limit=9).items] == ids
