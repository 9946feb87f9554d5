"""The worker processes, renewed when they cannot go on.

One that dies while none has a task takes its whole pool with it (pebble: "All workers expired"); so does one
that cannot even start. That must not end all diagnosing.
"""

import multiprocessing
import os
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from multiprocessing.synchronize import Semaphore

import structlog
from pebble import ProcessPool

from service.jobs.task import DiagnosisTask, Outcome, Task

log = structlog.get_logger(__name__)

STOP_TIMEOUT_S = 10.0
SHORTEST_DELAY_S, LONGEST_DELAY_S = 0.2, 30.0
STABLE_AFTER_S = 60.0


class WorkersEndedError(RuntimeError):
    """There are no workers at the moment; there will be."""


class WorkerPool:
    """Used by one thread. prepare_worker: runs first in every worker."""

    def __init__(self, workers: int, prepare_worker: Callable[[], None]) -> None:
        self._workers = workers
        self._prepare_worker = prepare_worker
        self._context = multiprocessing.get_context("spawn")
        self._delay_s = SHORTEST_DELAY_S
        self._renew_at_s: float | None = None
        self._ending: threading.Thread | None = None
        self._started_s = time.monotonic()
        self._begin()

    def start(self) -> None:
        """The workers load now instead of with the first task."""
        self._started_s = time.monotonic()
        self._pool.schedule(os.getpid)

    def schedule(self, function: Task, task: DiagnosisTask, timeout_s: float) -> "Future[Outcome]":
        """Raises WorkersEndedError; a task that was accepted may end with BrokenExecutor instead."""
        try:
            return self._pool.schedule(function, args=(task,), timeout=timeout_s)
        except RuntimeError as error:
            raise WorkersEndedError(str(error)) from error

    def loading(self) -> int:
        """How many workers are not ready yet."""
        while self._unprepared and self._prepared.acquire(block=False):
            self._unprepared -= 1
        return self._unprepared

    def has_ended(self) -> bool:
        """Whether all workers are gone, until `renew` has brought others."""
        if self._renew_at_s is None and not self._pool.active:
            if time.monotonic() - self._started_s > STABLE_AFTER_S:
                self._delay_s = SHORTEST_DELAY_S
            log.error("the worker processes ended and are started again", delay_s=self._delay_s)
            self._renew_at_s = time.monotonic() + self._delay_s
            self._delay_s = min(2 * self._delay_s, LONGEST_DELAY_S)
            # Aside, because it waits for its threads, one of which may wait for a process that is gone.
            self._ending = threading.Thread(target=_end, args=(self._pool,), name="workers-end", daemon=True)
            self._ending.start()
        return self._renew_at_s is not None

    def renew(self) -> None:
        """Other workers, once that is due: later each time it was in vain."""
        if self._renew_at_s is not None and time.monotonic() >= self._renew_at_s:
            self._renew_at_s = None
            self._begin()
            self.start()

    def stop(self) -> None:
        """End all workers, whatever they do."""
        if self._renew_at_s is None:
            _end(self._pool)
        if self._ending is not None:
            self._ending.join(STOP_TIMEOUT_S)

    def _begin(self) -> None:
        self._prepared = self._context.Semaphore(0)
        self._unprepared = self._workers
        self._pool = ProcessPool(
            max_workers=self._workers,
            initializer=_prepare,
            initargs=(self._prepare_worker, self._prepared),
            context=self._context,
        )


def _end(pool: ProcessPool) -> None:
    pool.stop()  # type: ignore[no-untyped-call]  # pebble annotates the rest of its pool
    pool.join(timeout=STOP_TIMEOUT_S)


def _prepare(prepare_worker: Callable[[], None], prepared: Semaphore) -> None:
    """Runs first in every worker, and tells the pool when it is done."""
    prepare_worker()
    prepared.release()
