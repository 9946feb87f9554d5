"""Work that somebody waits for, done by the diagnosis workers."""

import os
import signal
import time
from concurrent.futures import BrokenExecutor
from pathlib import Path

import pytest
from pebble import ProcessExpired

from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.states import JobState
from service.waveforms.computing import NoAnswerError
from testing.waiting import wait_until
from tests.service.jobs.running import running
from tests.service.jobs.stand_ins import fail_to_start


def pid_of(_: None) -> int:
    return os.getpid()


def refuse(what: str) -> None:
    raise ArithmeticError(what)


def die(_: None) -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def is_done(repository: Repository, recording: str) -> bool:
    return repository.jobs(recording, limit=1).items[0].job.state is JobState.DONE


def test_a_worker_answers_and_hands_over_what_it_raises(
    repository: Repository, store: RecordingStore
) -> None:
    with running(repository, store) as runner:
        assert runner.compute(pid_of, None).result(30.0) != os.getpid()
        with pytest.raises(ArithmeticError, match="no such number"):
            runner.compute(refuse, "no such number").result(30.0)
        with pytest.raises((ProcessExpired, BrokenExecutor)):
            runner.compute(die, None).result(30.0)
        assert runner.compute(pid_of, None).result(30.0) > 0


def test_answers_come_before_diagnoses_and_hold_none_up(
    repository: Repository, store: RecordingStore
) -> None:
    stored = [store.store({"E.CFF": b"slow", f"{k}.HDR": str(k).encode()}) for k in range(6)]
    with running(repository, store) as runner:
        added = [
            repository.add_recording(one, motor="PUMP-A1", now_ns=time.time_ns()).recording.id
            for one in stored
        ]
        answers = [runner.compute(pid_of, None) for _ in range(10)]
        assert all(answer.result(30.0) for answer in answers)
        wait_until(lambda: all(is_done(repository, recording) for recording in added))


def test_nobody_waits_for_workers_that_do_not_start(
    repository: Repository, store: RecordingStore, tmp_path: Path
) -> None:
    with running(repository, store, prepare_worker=fail_to_start) as runner:
        wait_until(lambda: "worker" in (runner.problem() or ""))
        with pytest.raises((NoAnswerError, BrokenExecutor)):
            runner.compute(pid_of, None).result(30.0)


def test_what_waits_when_the_service_ends_is_refused(repository: Repository, store: RecordingStore) -> None:
    with running(repository, store) as runner:
        pass
    with pytest.raises(NoAnswerError, match="the service ends"):
        runner.compute(pid_of, None).result(1.0)
