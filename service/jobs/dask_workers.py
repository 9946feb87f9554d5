"""Workers of a Dask cluster (https://distributed.dask.org): processes on any host that sees the recordings.

They have the task alone: the database is for the job runner. A worker of Dask cannot be told to drop a task,
so one that takes too long ends its process; Dask starts another one.
"""

import logging
import os
import platform
import socket
from collections.abc import Callable
from concurrent.futures import CancelledError, Future
from importlib.metadata import version
from threading import Timer
from types import TracebackType

from distributed import Client, LocalCluster

from service.jobs.task import DiagnosisTask, Outcome
from service.jobs.worker import diagnose_recording
from service.jobs.workers import Argument, NoWorkersError, Result
from service.recording_store.store import RecordingStore

PACKAGES = ("statorwatch", "numpy", "scipy", "numba")
"""The same versions give the same results."""

CONNECT_TIMEOUT_S = 20.0
CLOSE_TIMEOUT_S = 5.0
CONNECTED = "running"
TASKS_A_WORKER = 2
"""One under way, and one that waits at the scheduler: a worker is never without work."""


class UnusableClusterError(RuntimeError):
    """No scheduler answers, or its workers cannot do the work."""


class DaskWorkers:
    """Give tasks to the workers of a cluster; see `Workers` for what each method does.

    Once the scheduler is gone there are no workers again: what it knew is lost.
    """

    def __init__(self, client: Client, where: str, cluster: LocalCluster | None = None) -> None:
        self._client = client
        self._where = where
        self._cluster = cluster
        self._executor = client.get_executor(pure=False)

    @classmethod
    def of_this_machine(cls, processes: int) -> "DaskWorkers":
        """Start worker processes, which nobody else reaches: their connections are encrypted."""
        _silence()
        cluster = LocalCluster(
            n_workers=processes,
            threads_per_worker=1,
            processes=True,
            host="127.0.0.1",
            security=True,
            dashboard_address="127.0.0.1:0",
            silence_logs=logging.CRITICAL,
        )
        return cls(Client(cluster, set_as_default=False), "this machine", cluster)

    @classmethod
    def of_scheduler(cls, address: str, store: RecordingStore) -> "DaskWorkers":
        """Use the workers of a running scheduler. Raises UnusableClusterError.

        store: has the recordings, which they have to see as this host does.
        """
        _silence()
        try:
            client = Client(address, timeout=CONNECT_TIMEOUT_S, set_as_default=False)
        except (OSError, ValueError) as error:
            raise UnusableClusterError(
                f"--scheduler {address}: expected the address of a Dask scheduler that runs, such as "
                f"tcp://host:8786, found: {error}"
            ) from error
        try:
            _require_fit(client, address, store)
        except BaseException:
            client.close(timeout=CLOSE_TIMEOUT_S)
            raise
        return cls(client, address)

    def __enter__(self) -> "DaskWorkers":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    @property
    def places(self) -> int:
        """Return how many tasks it takes at once."""
        threads: dict[str, int] = self._client.nthreads()
        return TASKS_A_WORKER * sum(threads.values())

    @property
    def problem(self) -> str | None:
        if self._client.status == CONNECTED:
            return None
        return f"the Dask scheduler of {self._where} is gone"

    def has_ended(self) -> bool:
        return self.problem is not None

    def renew(self) -> None:
        """Do nothing: whoever started the scheduler starts it again."""

    def schedule(
        self, function: Callable[[Argument], Result], task: Argument, timeout_s: float
    ) -> "Future[Result]":
        if self.problem is not None:
            raise NoWorkersError(self.problem)
        try:
            future: Future[Result] = self._executor.submit(_within, timeout_s, function, task)
        except (OSError, RuntimeError, CancelledError) as error:
            raise NoWorkersError(str(error)) from error
        return future

    def loading(self) -> int:
        return 0

    def stop(self) -> None:
        self._client.close(timeout=CLOSE_TIMEOUT_S)
        if self._cluster is not None:
            self._cluster.close(timeout=CLOSE_TIMEOUT_S)


def diagnose_shared_recording(task: DiagnosisTask) -> Outcome:
    """Diagnose a recording as the service's own workers do. Raises OSError.

    A file that this host does not see is no damaged recording: another host may see it.
    """
    for source in (task.recording, *task.baseline):
        if not source.is_seen_here():
            raise FileNotFoundError(f"{source}: worker host {socket.gethostname()} does not see this file")
    return diagnose_recording(task)


def _within(timeout_s: float, function: Callable[[Argument], Result], task: Argument) -> Result:
    """Do a task in a worker, whose process ends where it takes too long."""
    limit = Timer(timeout_s, os._exit, args=(1,))
    limit.daemon = True
    limit.start()
    try:
        return function(task)
    finally:
        limit.cancel()


def _require_fit(client: Client, address: str, store: RecordingStore) -> None:
    """Raise UnusableClusterError where the workers cannot do what those of the service do."""
    threads = client.nthreads()
    if not threads:
        raise UnusableClusterError(
            f"--scheduler {address}: expected workers, found none: start some with "
            f"dask worker {address} --nworkers auto --nthreads 1"
        )
    many = [worker for worker, count in threads.items() if count != 1]
    if many:
        raise UnusableClusterError(
            f"worker {many[0]}: expected one thread, found {threads[many[0]]}: start it with --nthreads 1"
        )
    for worker, found in client.run(_software).items():
        if found != _software():
            raise UnusableClusterError(
                f"worker {worker}: expected the software of this host, {', '.join(_software())}, found "
                f"{', '.join(found)}: install the same there"
            )
    for worker, problem in client.run(store.problem).items():
        if problem is not None:
            raise UnusableClusterError(
                f"worker {worker}: expected the recordings in {store.place}, found: {problem}; it needs the "
                "same path, or the same store with an endpoint and credentials of its own"
            )


def _software() -> tuple[str, ...]:
    """Return the versions that results depend on."""
    return (f"Python {platform.python_version()}", *(f"{name} {version(name)}" for name in PACKAGES))


def _silence() -> None:
    """Leave it to the command to say that a connection is lost; Dask and Tornado tell it in many lines."""
    for name in logging.root.manager.loggerDict:
        if name.partition(".")[0] in {
            "distributed",
            "tornado",
        }:  # Dask gives several of them levels of their own
            logging.getLogger(name).setLevel(logging.CRITICAL)
