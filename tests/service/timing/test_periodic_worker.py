import time
from collections.abc import Iterator
from contextlib import contextmanager
from queue import SimpleQueue
from threading import Event

import pytest
from sqlalchemy.exc import IntegrityError, OperationalError, ProgrammingError, SQLAlchemyError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError

from service.timing.periodic_worker import PeriodicWorker
from testing.waiting import wait_until

LIMIT_S = 10.0


@contextmanager
def running(worker: PeriodicWorker) -> Iterator[None]:
    worker.start()
    try:
        yield
    finally:
        worker.stop()


def test_it_works_again_and_again_until_it_is_stopped() -> None:
    done: SimpleQueue[None] = SimpleQueue()
    worker = PeriodicWorker("counting", lambda: done.put(None), period_s=0.001)
    with running(worker):
        for _ in range(3):
            done.get(timeout=LIMIT_S)
        assert worker.problem() is None
    while not done.empty():
        done.get()
    assert done.empty()


@pytest.mark.parametrize("error", [SQLAlchemyError("locked"), RuntimeError("a bug")])
def test_a_failure_is_told_and_the_work_is_tried_again(error: Exception) -> None:
    failed, go_on, done = Event(), Event(), Event()

    def work() -> None:
        if not failed.is_set():
            failed.set()
            raise error
        go_on.wait(LIMIT_S)
        done.set()

    worker = PeriodicWorker("fragile", work, period_s=0.001, at_once=True)
    with running(worker):
        assert failed.wait(LIMIT_S)
        while worker.problem() is None:
            assert not done.is_set()
        assert str(error) in str(worker.problem())
        go_on.set()
        assert done.wait(LIMIT_S)
    assert worker.problem() is None


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (OperationalError("SELECT 1", {}, Exception("locked")), "does not answer"),
        (PoolTimeoutError("no connection"), "does not answer"),
        (IntegrityError("INSERT", {}, Exception("twice")), "refused a statement"),
        (ProgrammingError("SELEC", {}, Exception("syntax")), "refused a statement"),
    ],
)
def test_a_database_that_is_away_is_told_from_one_that_refuses(error: SQLAlchemyError, words: str) -> None:
    def fail() -> None:
        raise error

    worker = PeriodicWorker("asking", fail, period_s=0.01, at_once=True)
    with running(worker):
        wait_until(lambda: worker.problem() is not None)
        assert words in str(worker.problem())


def test_work_that_hangs_is_told() -> None:
    go_on = Event()

    def hang() -> None:
        go_on.wait(LIMIT_S)

    worker = PeriodicWorker("hanging", hang, period_s=0.01, at_once=True, overdue_s=0.05)
    with running(worker):
        try:
            wait_until(lambda: "hanging has been at work for" in str(worker.problem()))
        finally:
            go_on.set()
        wait_until(lambda: worker.problem() is None)


def test_it_can_be_woken_before_its_pause_is_over() -> None:
    done: SimpleQueue[None] = SimpleQueue()
    worker = PeriodicWorker("woken", lambda: done.put(None), period_s=3600.0, at_once=True)
    with running(worker):
        done.get(timeout=LIMIT_S)
        worker.wake()
        done.get(timeout=LIMIT_S)


def test_the_pauses_grow_while_unforeseen_errors_follow_each_other() -> None:
    attempts: SimpleQueue[float] = SimpleQueue()

    def fail() -> None:
        attempts.put(time.monotonic())
        raise RuntimeError("a bug")

    worker = PeriodicWorker("failing", fail, period_s=0.01, at_once=True)
    with running(worker):
        at_s = [attempts.get(timeout=LIMIT_S) for _ in range(6)]
    assert at_s[5] - at_s[4] >= 0.16, at_s


def test_one_that_has_not_started_says_so() -> None:
    assert PeriodicWorker("idle", lambda: None, period_s=1.0).problem() == "idle has not started"


def test_what_is_left_to_do_is_done_once_more_at_the_end() -> None:
    done: list[str] = []
    worker = PeriodicWorker("writing", lambda: done.append("written"), period_s=LIMIT_S, once_more=True)
    with running(worker):
        assert not done
    assert done == ["written"]
