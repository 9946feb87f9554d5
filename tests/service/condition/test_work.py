"""Workers that have nothing to diagnose fold conditions."""

import os
import signal
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import replace

import pytest
from pebble import ProcessExpired
from sqlalchemy.exc import OperationalError

from core.machines.parameters import Motor, ParametersSource
from core.time_stamps import nanoseconds
from service.alarms.condition_rules import ConditionRules
from service.api.conditions.documents import condition_document
from service.condition import work, worker
from service.condition.work import ConditionWork
from service.condition.worker import fold_due
from service.jobs.limits import JobLimits
from service.jobs.runner import JobRunner
from service.jobs.task import Diagnosed, DiagnosisTask, Outcome
from service.jobs.worker_process import follow_service
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Backlog
from service.storage.states import JobState
from service.timing.backoff import Backoff
from testing.service.findings import findings_of
from testing.service.following import FAN, PUMP, Recorder, fold_all
from testing.service.observations import HOUR_NS
from testing.service.plants import NOW_NS, healthy
from testing.waiting import wait_until
from tests.service.condition.tasks import MOTORS, RECORDS, failed

WRONG_CLOCKS = {
    100: replace(RECORDS[0], time_ns=nanoseconds("2095-01-01T00:00:00Z")),
    101: replace(RECORDS[0], time_ns=HOUR_NS),
}
LIMITS = JobLimits(workers=2, job_timeout_s=30.0, attempts=2, backoff=Backoff(0.01, 0.1), lease_s=30.0)


def observe_as_told(task: DiagnosisTask) -> Outcome:
    """A task that stands in for the diagnosis: the file says which of RECORDS it is."""
    with task.recording.opened() as entry:
        at = int(entry.read_text())
    observation = WRONG_CLOCKS[at] if at in WRONG_CLOCKS else RECORDS[at]
    return Diagnosed(findings_of(healthy(), observation=observation), observation.time_ns)


@contextmanager
def running(
    repository: Repository,
    store: RecordingStore,
    database_url: str,
    prepare_worker: Callable[[], None] = follow_service,
) -> Iterator[JobRunner]:
    conditions = ConditionWork(repository, MOTORS, database_url=database_url)
    runner = JobRunner(
        repository,
        store,
        MOTORS,
        observe_as_told,
        limits=LIMITS,
        installation="ours",
        conditions=conditions,
        prepare_worker=prepare_worker,
        poll_period_s=0.05,
    )
    runner.start()
    try:
        yield runner
    finally:
        runner.stop()


def test_what_comes_ends_in_conditions(
    repository: Repository, store: RecordingStore, database_url: str
) -> None:
    """One run for all of it: workers take seconds to load."""
    for at in reversed(range(len(RECORDS))):
        stored = store.store({"E.CFF": str(at).encode()})
        repository.add_recording(stored, motor=FAN, now_ns=time.time_ns())
    wrong_clocks = [
        repository.add_recording(
            store.store({"E.CFF": str(at).encode()}), motor=FAN, now_ns=time.time_ns()
        ).recording.id
        for at in WRONG_CLOCKS
    ]
    with running(repository, store, database_url) as runner:
        done = len(RECORDS) + len(wrong_clocks)
        wait_until(lambda: repository.counts().jobs == {JobState.DONE: done}, within_s=60)
        wait_until(lambda: repository.backlog() == Backlog(0), within_s=60)
        assert runner.problem() is None
    points = repository.condition_trend(FAN, limit=100).items
    assert [point.time_ns for point in points] == [record.time_ns for record in RECORDS]
    assert repository.condition(FAN).as_of_ns == RECORDS[-1].time_ns
    for id_, wrong in zip(wrong_clocks, ("2095", "before the year 2000"), strict=True):
        assert repository.observation(id_) is None
        reason = repository.recording(id_).reason
        assert reason is not None
        assert wrong in reason
        assert "set the relay's clock" in reason


def test_motors_take_turns_and_each_has_one_task(
    repository: Repository, store: RecordingStore, database_url: str
) -> None:
    recorder = Recorder(repository, store)
    for name in (PUMP, FAN):
        recorder.record(RECORDS[0], name)
    conditions = ConditionWork(repository, MOTORS, database_url=database_url)
    tasks = [conditions.next_task() for _ in range(3)]
    given = [task for task in tasks if task is not None]
    assert sorted(task.motor for task in given) == [FAN, PUMP]
    assert conditions.tasks_under_way == 2
    conditions.give_back()
    first = conditions.next_task()
    assert first is not None
    assert first.motor == given[0].motor, "the other one was the latest"
    conditions.ended(given[0], failed(RuntimeError("late")))
    assert conditions.tasks_under_way == 1, "the late end of a task that was given back is no end of the new"
    conditions.ended(first, failed(BrokenProcessPool("the workers ended")))
    again = conditions.next_task()
    assert again is not None
    assert again.motor == given[1].motor, "the other motor's turn"


def test_a_motor_that_cannot_be_folded_is_tried_again_later(
    repository: Repository, store: RecordingStore, database_url: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    Recorder(repository, store).record(RECORDS[0])
    for pause_s in (100.0, 0.0):
        monkeypatch.setattr(work, "FAILURES", Backoff(pause_s, pause_s))
        conditions = ConditionWork(repository, MOTORS, database_url=database_url)
        task = conditions.next_task()
        assert task is not None
        conditions.ended(task, failed(RuntimeError("a bug")))
        assert (conditions.next_task() is None) == (pause_s > 0.0)


KILLED = ProcessExpired("Abnormal termination", code=-9)  # type: ignore[no-untyped-call]  # pebble's


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (RuntimeError("a bug"), "RuntimeError: a bug"),
        (KILLED, "the worker process died (exit code -9)"),
        (TimeoutError("Task timeout"), "it took too long"),
    ],
)
def test_a_motor_whose_fold_fails_three_times_is_set_aside_until_something_changes(
    repository: Repository,
    store: RecordingStore,
    database_url: str,
    monkeypatch: pytest.MonkeyPatch,
    error: Exception,
    words: str,
) -> None:
    monkeypatch.setattr(work, "FAILURES", Backoff(0.0, 0.0))
    recorder = Recorder(repository, store)
    (first, *_) = recorder.record_all(RECORDS[:2])
    recorder.record(RECORDS[0], FAN)
    conditions = ConditionWork(repository, MOTORS, database_url=database_url)

    def tries() -> int:
        """How often the pump is tried; every try fails. The fan is folded."""
        number = 0
        while (task := conditions.next_task()) is not None:
            if task.motor == PUMP:
                number += 1
                conditions.ended(task, failed(error))
            else:
                folded: Future[int] = Future()
                folded.set_result(fold_due(repository, task.fold.motor))
                conditions.ended(task, folded)
        return number

    assert tries() == 3
    assert repository.condition(FAN).as_of_ns == RECORDS[0].time_ns
    problem = repository.condition(PUMP).problem
    assert problem == f"folding failed 3 times, the last time: {words}"
    assert repository.backlog() == Backlog(motors_to_fold=0, motors_set_aside=1)
    told = condition_document(repository.condition(PUMP), NOW_NS, HOUR_NS, source=ParametersSource.GIVEN)
    assert problem in told.reasons[0]
    assert "tried again with the next record" in told.reasons[0]
    assert tries() == 0
    recorder.record(RECORDS[2])
    assert tries() == 3, "a new record"
    recorder.diagnose_again(first, RECORDS[0])
    assert tries() == 3, "another diagnosis"
    conditions = ConditionWork(repository, MOTORS, database_url=database_url)
    assert tries() == 0
    conditions.begin()
    assert tries() == 3, "a service that starts"
    recorder.record(RECORDS[3])
    fold_all(repository)
    assert repository.condition(PUMP).problem is None
    assert repository.condition(PUMP).as_of_ns == RECORDS[3].time_ns, "all of them count in the end"
    assert repository.backlog() == Backlog(0)


def test_a_record_that_comes_during_the_failing_fold_has_the_motor_tried_again(
    repository: Repository, store: RecordingStore, database_url: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(work, "FAILURES", Backoff(0.0, 0.0))
    recorder = Recorder(repository, store)
    recorder.record(RECORDS[0])
    conditions = ConditionWork(repository, MOTORS, database_url=database_url)
    for number in range(3):
        task = conditions.next_task()
        assert task is not None
        if number == 2:
            recorder.record(RECORDS[1])
        conditions.ended(task, failed(RuntimeError("a bug")))
    assert repository.condition(PUMP).problem is not None
    assert conditions.next_task() is not None, "the record that has come does not wait for another one"
    fold_all(repository)
    assert repository.condition(PUMP).problem is None
    assert repository.condition(PUMP).as_of_ns == RECORDS[1].time_ns
    assert repository.backlog() == Backlog(0)


def test_a_database_that_does_not_answer_sets_no_motor_aside(
    repository: Repository, store: RecordingStore, database_url: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(work, "FAILURES", Backoff(0.0, 0.0))
    Recorder(repository, store).record(RECORDS[0])
    conditions = ConditionWork(repository, MOTORS, database_url=database_url)
    for _ in range(5):
        task = conditions.next_task()
        assert task is not None
        conditions.ended(task, failed(OperationalError("UPDATE", {}, Exception("database is locked"))))
    assert repository.condition(PUMP).problem is None


def die_of_the_pump() -> None:
    """Prepare a worker that is killed by each fold of the pump."""
    follow_service()

    def fold_or_die(
        repository: Repository, motor: Motor, round_s: float, *, alarm_rules: ConditionRules
    ) -> int:
        if motor.name == PUMP:
            os.kill(os.getpid(), signal.SIGKILL)
        return fold_due(repository, motor, round_s, alarm_rules=alarm_rules)

    worker.fold_due = fold_or_die  # type: ignore[assignment]  # in a process of its own


@pytest.mark.campaign  # workers take seconds to load, and are loaded anew after each kill
def test_folds_that_kill_their_worker_hold_up_no_other_motor(
    repository: Repository, store: RecordingStore, database_url: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(work, "FAILURES", Backoff(0.01, 0.01))
    recorder = Recorder(repository, store)
    recorder.record(RECORDS[0])
    recorder.record(RECORDS[0], FAN)
    with running(repository, store, database_url, prepare_worker=die_of_the_pump):
        wait_until(lambda: repository.backlog() == Backlog(0, motors_set_aside=1), within_s=60)
        assert repository.condition(FAN).as_of_ns == RECORDS[0].time_ns
    assert "the worker process died (exit code -9)" in str(repository.condition(PUMP).problem)
