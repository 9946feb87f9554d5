"""Recordings that cannot be observed or folded are left out at last, and tried again later."""

import pickle
from concurrent.futures import Future
from typing import Any

import pytest
from sqlalchemy import Engine
from sqlalchemy.orm import Session

from core.condition.following.follower import Follower
from core.condition.observation import Observation
from service.condition import work
from service.condition.errors import RecordFoldError
from service.condition.work import ConditionWork
from service.condition.worker import ObserveTask
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.models import UnobservedRecordingRow
from service.timing.backoff import Backoff
from testing.service.following import FAN, PUMP, Recorder, fold_all
from testing.service.plants import NOW_NS
from tests.service.condition.tasks import MOTORS, RECORDS, failed


def test_a_recording_that_brings_its_worker_down_is_left_out_at_last(
    repository: Repository,
    store: RecordingStore,
    database_url: str,
    engine: Engine,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(work, "FAILURES", Backoff(0.0, 0.0))
    recorder = Recorder(repository, store)
    ids = [recorder.record(None) for _ in range(3)]
    with Session(engine) as session, session.begin():
        session.add_all(
            UnobservedRecordingRow(recording_id=id_, motor=PUMP, recorded_ns=NOW_NS + at)
            for at, id_ in enumerate(ids)
        )
    conditions = ConditionWork(repository, store, MOTORS, database_url=database_url)
    asked = []
    for _ in range(3):
        task = conditions.next_task()
        assert task is not None
        assert isinstance(task.argument, ObserveTask)
        asked.append([one.recording_id for one in task.argument.recordings])
        conditions.ended(task, failed(RuntimeError("its worker died")))
    assert asked == [ids, ids[:1], ids[:1]]
    assert repository.backlog().unobserved_recordings == 2


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
    conditions = ConditionWork(repository, store, MOTORS, database_url=database_url)
    tries = 0
    while (task := conditions.next_task()) is not None:
        tries += 1
        assert tries < 10
        future: Future[int] = Future()
        try:
            future.set_result(task.function(task.argument))
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
