"""Run the worker processes, and replace them when they cannot go on.

All are forked from one process that has loaded what they need (service.jobs.worker_parent): a worker starts
at once, and libraries and machine code are in memory once.

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
from threading import Event, Thread
from typing import Final

import structlog
from pebble import ProcessPool

from service.jobs.worker_process import prepare
from service.jobs.workers import Argument, NoWorkersError, Result
from service.process.termination import held_back
from service.timing.backoff import RestartDelay

log = structlog.get_logger(__name__)

STOP_TIMEOUT_S = 10.0

PARENT: Final = "service.jobs.worker_parent"
"""The module that the workers' parent loads before it forks the first of them."""

ENDED: Final = "the worker processes ended and are started again"

LOADING_LOOK_S: Final = 0.02
"""How often it is looked whether workers that load have ended instead."""


class WorkerPool:
    """Run the worker processes. For use by one thread.

    prepare_worker: runs first in every worker. is_ending: the service is asked to end, and its workers may
    have been too; no others are started. on_loaded: called by another thread when workers have been loaded,
    or could not be.
    """

    def __init__(
        self,
        workers: int,
        prepare_worker: Callable[[], None],
        is_ending: Callable[[], bool],
        on_loaded: Callable[[], None] = lambda: None,
    ) -> None:
        self._workers = workers
        self._prepare_worker = prepare_worker
        self._is_ending = is_ending
        self._on_loaded = on_loaded
        self._loading: _Loading | None = None
        self._pool: ProcessPool | None = None
        self._started_s = 0.0
        self._delay = RestartDelay()
        self._problem: str | None = None
        self._retry_at_s = time.monotonic()
        self._ending: list[Thread] = []

    @property
    def problem(self) -> str | None:
        """Return why there are no workers at present; None while there are, or while they load."""
        return self._problem if self._pool is None and self._loading is None else None

    def has_ended(self) -> bool:
        """Return whether there are no workers, until `renew` has had some started."""
        if self._loading is not None and self._loading.is_over:
            self._take_over(self._loading)
        if self._pool is not None and not self._pool.active:
            self._lose(self._pool)
        return self._pool is None and self._loading is None

    def renew(self) -> None:
        """Start workers where there are none, after a pause that grows with each failure to do so."""
        if not self.has_ended() or time.monotonic() < self._retry_at_s or self._is_ending():
            return
        self._started_s = time.monotonic()
        self._loading = _Loading(self._workers, self._prepare_worker, self._on_loaded)

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
        return 0 if self._pool is not None else self._workers

    def stop(self) -> None:
        """End all workers, whatever they do."""
        if self._loading is not None:
            self._loading.give_up()
            self._loading = None
        if self._pool is not None:
            _end(self._pool)
            self._pool = None
        for ending in self._ending:
            ending.join(STOP_TIMEOUT_S)

    def _take_over(self, loading: "_Loading") -> None:
        """Use the workers that have been loaded, or have others started later."""
        self._loading = None
        if loading.problem is None:
            self._pool = loading.pool
        else:
            lasted_s = time.monotonic() - self._started_s if loading.has_begun else 0.0
            self._retry_later(loading.problem, lasted_s)

    def _lose(self, pool: ProcessPool) -> None:
        """Leave workers that have ended, and have others started.

        The pool is stopped in a thread of its own, because that waits for the pool's threads, one of which
        may wait for a process that is gone.
        """
        ending = Thread(target=_end, args=(pool,), name="workers-end", daemon=True)
        ending.start()
        self._ending = [*(earlier for earlier in self._ending if earlier.is_alive()), ending]
        self._pool = None
        self._retry_later(ENDED, time.monotonic() - self._started_s)

    def _retry_later(self, problem: str, lasted_s: float) -> None:
        """Have workers started after a pause; the last ones lasted so long."""
        self._problem = problem
        pause_s = self._delay.after_run_s(lasted_s)
        self._retry_at_s = time.monotonic() + pause_s
        if not self._is_ending():
            log.error(problem, pause_s=pause_s)


class _Loading:
    """Workers that are started, in a thread: their parent may have to compile for minutes before.

    pool: whose workers are all ready, where there is no problem. Both are for others once it `is_over`.
    """

    def __init__(
        self, workers: int, prepare_worker: Callable[[], None], on_loaded: Callable[[], None]
    ) -> None:
        self._workers = workers
        self._prepare_worker = prepare_worker
        self._on_loaded = on_loaded
        self._given_up = Event()
        self._over = Event()
        self.has_begun = False
        self.problem: str | None = None
        self.pool: ProcessPool | None = None
        Thread(target=self._run, name="workers-load", daemon=True).start()

    @property
    def is_over(self) -> bool:
        """Whether the workers are ready, or cannot be had."""
        return self._over.is_set()

    def give_up(self) -> None:
        """End the workers as soon as they are there. Their parent ends with this process."""
        self._given_up.set()
        if self._over.is_set() and self.pool is not None:
            _end(self.pool)

    def _run(self) -> None:
        try:
            self._load()
        # RuntimeError: pebble's, whose cause is one of the others; or there is no thread left.
        except (OSError, EOFError, RuntimeError) as error:
            self.problem = f"the worker processes cannot be started: {_reason(error.__cause__ or error)}"
        if self.pool is not None and self.problem is not None:
            _end(self.pool)  # some of its workers may have started
        self._over.set()
        # Who gives up looks whether it is over, and here it is looked again: one of both ends the workers.
        if self.pool is not None and self._given_up.is_set():
            _end(self.pool)
        self._on_loaded()

    def _load(self) -> None:
        """Start the workers, and wait until all are ready. Raises OSError, EOFError, RuntimeError."""
        context = multiprocessing.get_context("forkserver")
        context.set_forkserver_preload([PARENT])
        prepared = context.Semaphore(0)
        self.pool = ProcessPool(
            max_workers=self._workers,
            initializer=prepare,
            initargs=(self._prepare_worker, prepared),
            context=context,
        )
        # The parent of the workers, and the pool's threads, begin here.
        with held_back(signal.SIGINT):
            self.pool.schedule(os.getpid)
        self.has_begun = True
        for _ in range(self._workers):
            self._await_one(prepared, self.pool)

    def _await_one(self, prepared: Semaphore, pool: ProcessPool) -> None:
        """Wait until one more worker is ready, unless they end."""
        while self.problem is None and not self._given_up.is_set():
            if prepared.acquire(timeout=LOADING_LOOK_S):
                return
            if not pool.active:
                self.problem = ENDED


def _reason(error: BaseException) -> str:
    """Say why there are no workers. A parent that can neither load nor fork ends with a traceback."""
    return "their parent has ended, its error is above" if isinstance(error, EOFError) else str(error)


def _end(pool: ProcessPool) -> None:
    """End all workers of a pool, and wait for that."""
    pool.stop()  # type: ignore[no-untyped-call]  # pebble annotates the rest of its pool
    pool.join(timeout=STOP_TIMEOUT_S)
