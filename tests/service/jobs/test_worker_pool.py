"""Workers that share a pipe, and let others go first."""

import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor
from contextlib import contextmanager
from typing import NoReturn

from pebble import CONSTS, ProcessExpired

from service.jobs.worker_pool import WorkerPool
from service.jobs.worker_process import LOCK_TIMEOUT_S, NICENESS
from service.jobs.workers import NoWorkersError
from testing.waiting import wait_until

SHORT_S = 0.2


class KilledOnTheWay:
    """Kills the worker that sends it, which has the lock of the pipe then."""

    def __reduce__(self) -> NoReturn:
        os.kill(os.getpid(), signal.SIGKILL)
        raise AssertionError("the process goes on")


def killed_on_the_way(_task: int) -> KilledOnTheWay:
    return KilledOnTheWay()


def lock_timeout_s(_task: int) -> float:
    return CONSTS.channel_lock_timeout


def niceness(_task: int) -> int:
    return os.getpriority(os.PRIO_PROCESS, 0)


def prepare() -> None:
    """Load nothing."""


def prepare_for_short_waits() -> None:
    CONSTS.channel_lock_timeout = SHORT_S


@contextmanager
def running_pool(prepare_worker: Callable[[], None]) -> Iterator[WorkerPool]:
    pool = WorkerPool(2, prepare_worker, is_ending=lambda: False)
    try:
        pool.renew()
        wait_until(lambda: is_ready(pool), "workers")
        yield pool
    finally:
        pool.stop()


def is_ready(pool: WorkerPool) -> bool:
    return not pool.has_ended() and not pool.loading()


def answers(pool: WorkerPool) -> bool:
    """Whether a worker does a task, as far as the runner's own care for its workers brings that about."""
    if pool.has_ended():
        pool.renew()
    try:
        return pool.schedule(lock_timeout_s, 0, timeout_s=60).result(timeout=30) > 0
    except (NoWorkersError, ProcessExpired, BrokenExecutor):
        return False


def test_others_take_over_from_a_worker_that_is_killed_while_it_answers() -> None:
    with running_pool(prepare_for_short_waits) as pool:
        assert isinstance(pool.schedule(killed_on_the_way, 0, timeout_s=60).exception(30), ProcessExpired)
        wait_until(lambda: answers(pool), "a worker to do a task")


def test_workers_that_still_load_end_with_their_pool() -> None:
    pool = WorkerPool(2, prepare, is_ending=lambda: False)
    pool.renew()
    pool.stop()
    with running_pool(prepare):  # the parent of both has forked what was asked of it before
        assert len(multiprocessing.active_children()) >= 2
    wait_until(lambda: not multiprocessing.active_children(), "the end of all workers")


def test_workers_let_those_go_first_who_fetch_records() -> None:
    expected = min(os.getpriority(os.PRIO_PROCESS, 0) + NICENESS, 19)
    with running_pool(prepare) as pool:
        assert pool.schedule(niceness, 0, timeout_s=60).result(30) == expected


def test_no_worker_waits_long_for_the_pipe() -> None:
    with running_pool(prepare) as pool:
        assert pool.schedule(lock_timeout_s, 0, timeout_s=60).result(30) == LOCK_TIMEOUT_S
