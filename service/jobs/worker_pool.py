"""Run the worker processes, and replace them when they cannot go on.

A worker that dies while none has a task takes its whole pool with it (pebble: "All workers expired"); so does
one that cannot even start. A machine that is short of memory, processes or file descriptors starts none at
all. None of this may end all diagnosing.
"""

import multiprocessing
import os
import signal
import time
from collections.abc import Callable
from concurrent.futures import Future
from multiprocessing.synchronize import Semaphore
from threading import Thread

import structlog
from pebble import ProcessPool

from service.jobs.worker_process import prepare
from service.jobs.workers import Argument, NoWorkersError, Result
from service.process.termination import held_back
from service.timing.backoff import RestartDelay

log = structlog.get_logger(__name__)

STOP_TIMEOUT_S = 10.0


class WorkerPool:
    """Run the worker processes. For use by one thread.

    prepare_worker: runs first in every worker. is_ending: the service is asked to end, and its workers may
    have been too; no others are started.
    """

    def __init__(
        self, workers: int, prepare_worker: Callable[[], None], is_ending: Callable[[], bool]
    ) -> None:
        self._workers = workers
        self._prepare_worker = prepare_worker
        self._is_ending = is_ending
        self._context = multiprocessing.get_context("spawn")
        self._pool: ProcessPool | None = None
        self._prepared: Semaphore | None = None
        self._unprepared = workers
        self._started_s = 0.0
        self._delay = RestartDelay()
        self._problem: str | None = None
        self._retry_at_s = time.monotonic()
        self._ending: list[Thread] = []

    @property
    def problem(self) -> str | None:
        """Return why there are no workers at present; None while there are."""
        return self._problem if self._pool is None else None

    def has_ended(self) -> bool:
        """Return whether there are no workers, until `renew` has started some."""
        if self._pool is not None and not self._pool.active:
            self._lose(self._pool)
        return self._pool is None

    def renew(self) -> None:
        """Start workers where there are none, after a pause that grows with each failure to do so."""
        if self._pool is None and time.monotonic() >= self._retry_at_s and not self._is_ending():
            self._start()

    def schedule(
        self, function: Callable[[Argument], Result], task: Argument, timeout_s: float
    ) -> "Future[Result]":
        """Give a task to a worker. Raises NoWorkersError.

        A task that was accepted ends with BrokenExecutor where the workers end.
        """
        if self._pool is None:
            raise NoWorkersError(self._problem)
        try:
            return self._pool.schedule(function, args=(task,), timeout=timeout_s)
        except RuntimeError as error:
            raise NoWorkersError(str(error)) from error

    def loading(self) -> int:
        """Return how many workers are not ready yet."""
        while self._unprepared and self._prepared is not None and self._prepared.acquire(block=False):
            self._unprepared -= 1
        return self._unprepared

    def stop(self) -> None:
        """End all workers, whatever they do."""
        if self._pool is not None:
            _end(self._pool)
            self._pool = None
        for ending in self._ending:
            ending.join(STOP_TIMEOUT_S)

    def _start(self) -> None:
        """Start the workers; they load now instead of with the first task."""
        pool = None
        try:
            self._prepared = self._context.Semaphore(0)
            self._unprepared = self._workers
            pool = ProcessPool(
                max_workers=self._workers,
                initializer=prepare,
                initargs=(self._prepare_worker, self._prepared),
                context=self._context,
            )
            with held_back(signal.SIGINT):  # the pool's threads, which start all workers, begin here
                pool.schedule(os.getpid)
        # RuntimeError: pebble's, whose cause is an OSError; or there is no thread left.
        except (OSError, RuntimeError) as error:
            if pool is not None:
                _end(pool)  # some of its workers may have started
            problem = f"the worker processes cannot be started: {error.__cause__ or error}"
            self._retry_later(problem, lasted_s=0.0)
        else:
            self._pool = pool
            self._started_s = time.monotonic()

    def _lose(self, pool: ProcessPool) -> None:
        """Leave workers that have ended, and have others started.

        The pool is stopped in a thread of its own, because that waits for the pool's threads, one of which
        may wait for a process that is gone.
        """
        ending = Thread(target=_end, args=(pool,), name="workers-end", daemon=True)
        ending.start()
        self._ending = [*(earlier for earlier in self._ending if earlier.is_alive()), ending]
        self._pool = None
        lasted_s = time.monotonic() - self._started_s
        self._retry_later("the worker processes ended and are started again", lasted_s)

    def _retry_later(self, problem: str, lasted_s: float) -> None:
        """Have workers started after a pause; the last ones lasted so long."""
        self._problem = problem
        pause_s = self._delay.after_run_s(lasted_s)
        self._retry_at_s = time.monotonic() + pause_s
        if not self._is_ending():
            log.error(problem, pause_s=pause_s)


def _end(pool: ProcessPool) -> None:
    """End all workers of a pool, and wait for that."""
    pool.stop()  # type: ignore[no-untyped-call]  # pebble annotates the rest of its pool
    pool.join(timeout=STOP_TIMEOUT_S)
