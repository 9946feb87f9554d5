"""Workers of a Dask cluster (https://distributed.dask.org): processes on any host that sees the recordings.

They have the task alone: the database is for the job runner. A worker of Dask cannot be told to drop a task,
so one that takes too long ends its process; Dask starts another one.

Dask's client unpickles whatever a scheduler sends it. So it runs in a process of its own (`dask_client`), in
which pickles hold no objects. What comes from there is plain data, and is read as what a stranger writes.
"""

import base64
import json
import os
import pickle
import queue
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from contextlib import suppress
from threading import Lock, Thread
from types import TracebackType
from typing import IO, Annotated, Any, Final, Literal, cast

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from core.error_words import one_line
from service.configuration.dask import DaskTls, SchedulerAddressError, require_guarded
from service.jobs.dask_tasks import software
from service.jobs.plain import PlainDataError, read_outcome
from service.jobs.task import DiagnosisTask, Outcome
from service.jobs.worker import diagnose_recording
from service.jobs.workers import Argument, NoWorkersError, Result, WorkerFailedError
from service.recording_store.errors import StoreUnreachableError
from service.recording_store.store import RecordingStore

COMMAND: Final = (sys.executable, "-P", "-m", "service.jobs.dask_client")
READY_TIMEOUT_S: Final = 180.0
"""Longer than the client waits for scheduler and workers: it says why it cannot go on."""

CLOSE_TIMEOUT_S: Final = 15.0
LONGEST_LINE: Final = 64 * 1024**2
LONGEST_REASON: Final = 400
TASKS_A_WORKER: Final = 2
"""One under way, and one that waits at the scheduler: a worker is never without work."""

HANDED_ON: Final = (
    "HOME", "LANG", "LC_ALL", "LC_CTYPE", "LD_LIBRARY_PATH", "OPENBLAS_NUM_THREADS", "PATH", "TMPDIR", "TZ",
)  # fmt: skip
"""Variables of the environment that the client of a scheduler gets. Passwords and tokens are in others."""


class UnusableClusterError(RuntimeError):
    """No scheduler answers, or its workers cannot do the work."""


class _Message(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class _Ready(_Message):
    """threads: of each worker.  descriptions: what it says of itself, as JSON; None where it says nothing."""

    kind: Literal["ready"]
    threads: dict[str, int]
    descriptions: dict[str, str | None]


class _Refused(_Message):
    kind: Literal["refused"]
    reason: str


class _Answer(_Message):
    kind: Literal["answer"]
    id: int
    text: str | None
    failure: str | None


class _Gone(_Message):
    kind: Literal["gone"]


class _Description(_Message):
    software: list[str]
    problem: str | None


_MESSAGES: Final[TypeAdapter[_Ready | _Refused | _Answer | _Gone]] = TypeAdapter(
    Annotated[_Ready | _Refused | _Answer | _Gone, Field(discriminator="kind")]
)


class DaskWorkers:
    """Give tasks to the workers of a cluster; see `Workers` for what each method does.

    Once the scheduler is gone there are no workers again: what it knew is lost.
    """

    def __init__(self, order: Mapping[str, object], where: str, environment: Mapping[str, str]) -> None:
        """Start the client. Raises UnusableClusterError."""
        self._where = where
        self._has_scheduler = order["address"] is not None
        self._lock = Lock()
        self._last_id = 0
        self._open: dict[int, Future[Outcome]] = {}
        self._gone: str | None = None
        self._first: queue.SimpleQueue[_Ready | _Refused | None] = queue.SimpleQueue()
        self._process = subprocess.Popen(  # noqa: S603 - this program itself
            COMMAND, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
            env=dict(environment), start_new_session=True,
        )  # fmt: skip
        self._to_client = cast("IO[bytes]", self._process.stdin)
        from_client = cast("IO[bytes]", self._process.stdout)
        self._reader = Thread(target=self._read, args=(from_client,), name="dask-client", daemon=True)
        self._reader.start()
        try:
            self._send(order)
            self.ready = self._began()
        except BaseException:
            self.stop()
            raise

    @classmethod
    def of_this_machine(cls, processes: int) -> "DaskWorkers":
        """Start worker processes, which nobody else reaches: their connections are encrypted."""
        order = {"address": None, "processes": processes, "tls": None, "store": None}
        return cls(order, "this machine", {**os.environ, **_search_path()})

    @classmethod
    def of_scheduler(cls, address: str, store: RecordingStore, tls: DaskTls | None) -> "DaskWorkers":
        """Use the workers of a running scheduler. Raises UnusableClusterError.

        store: has the recordings, which they have to see as this host does.  tls: files for it; needed
        beyond this host.
        """
        try:
            require_guarded(address, tls)
        except SchedulerAddressError as error:
            raise UnusableClusterError(f"--scheduler: {error}") from error
        is_secured = address.startswith("tls:") and tls is not None
        order = {
            "address": address,
            "processes": 0,
            "tls": tls.model_dump(mode="json") if is_secured and tls is not None else None,
            "store": _text_of(store),
        }
        handed_on = {name: os.environ[name] for name in HANDED_ON if name in os.environ}
        workers = cls(order, address, {**handed_on, **_search_path()})
        try:
            _require_fit(workers.ready, address, store)
        except BaseException:
            workers.stop()
            raise
        return workers

    def __enter__(self) -> "DaskWorkers":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    @property
    def client_pid(self) -> int:
        """Return the id of the process that speaks with the scheduler."""
        return self._process.pid

    @property
    def places(self) -> int:
        """Return how many tasks it takes at once."""
        return TASKS_A_WORKER * sum(self.ready.threads.values())

    @property
    def problem(self) -> str | None:
        return self._gone

    def has_ended(self) -> bool:
        return self.problem is not None

    def renew(self) -> None:
        """Do nothing: whoever started the scheduler starts it again."""

    def schedule(
        self, function: Callable[[Argument], Result], task: Argument, timeout_s: float
    ) -> "Future[Result]":
        """Give a task to a worker. Raises NoWorkersError. The function has to return an Outcome."""
        future: Future[Outcome] = Future()
        with self._lock:
            if self._gone is not None:
                raise NoWorkersError(self._gone)
            self._last_id += 1
            number = self._last_id
            self._open[number] = future
        try:
            self._send({"id": number, "work": _text_of((function, task)), "timeout_s": timeout_s})
        except OSError as error:
            with self._lock:
                self._open.pop(number, None)
            raise NoWorkersError(str(error)) from error
        return cast("Future[Result]", future)

    def loading(self) -> int:
        return 0

    def stop(self) -> None:
        with suppress(OSError):  # it has ended
            self._to_client.close()
        try:
            self._process.wait(CLOSE_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            os.killpg(self._process.pid, signal.SIGKILL)  # with what it started
            self._process.wait()
        self._reader.join(CLOSE_TIMEOUT_S)

    def _send(self, message: Mapping[str, object]) -> None:
        self._to_client.write(f"{json.dumps(message)}\n".encode("ascii"))
        self._to_client.flush()

    def _began(self) -> _Ready:
        try:
            first = self._first.get(timeout=READY_TIMEOUT_S)
        except queue.Empty:
            first = _Refused(kind="refused", reason="no answer in time")
        if isinstance(first, _Ready):
            return first
        reason = "its client ended" if first is None else _shown(first.reason)
        if not self._has_scheduler:
            raise UnusableClusterError(f"the worker processes cannot be started: {reason}")
        raise UnusableClusterError(
            f"--scheduler {self._where}: expected the address of a Dask scheduler that runs, such as "
            f"tls://host:8786, found: {reason}"
        )

    def _read(self, lines: IO[bytes]) -> None:
        """Read what the client gives back, until it ends."""
        with lines:
            while line := lines.readline(LONGEST_LINE):
                try:
                    message = _MESSAGES.validate_json(line)
                except ValidationError:  # it is not ours any more
                    break
                if isinstance(message, _Gone):
                    break
                if isinstance(message, _Answer):
                    self._answered(message)
                else:
                    self._first.put(message)
        self._end()

    def _answered(self, message: _Answer) -> None:
        with self._lock:
            future = self._open.pop(message.id, None)
        if future is None or not future.set_running_or_notify_cancel():
            return
        if message.text is None:
            future.set_exception(WorkerFailedError(_shown(message.failure or "a worker gave no answer")))
            return
        try:
            outcome = read_outcome(message.text)
        except PlainDataError as error:
            future.set_exception(
                WorkerFailedError(f"a worker's answer is no outcome of a diagnosis: {error}")
            )
        except (WorkerFailedError, StoreUnreachableError) as error:
            future.set_exception(error)
        else:
            future.set_result(outcome)

    def _end(self) -> None:
        with self._lock:
            self._gone = f"the Dask scheduler of {self._where} is gone"
            left, self._open = list(self._open.values()), {}
        for future in left:
            future.cancel()
            future.set_running_or_notify_cancel()
        self._first.put(None)


def diagnose_shared_recording(task: DiagnosisTask) -> Outcome:
    """Diagnose a recording as the service's own workers do. Raises OSError.

    A file that this host does not see is no damaged recording: another host may see it.
    """
    for source in (task.recording, *task.baseline):
        if not source.is_seen_here():
            raise FileNotFoundError(f"{source}: worker host {socket.gethostname()} does not see this file")
    return diagnose_recording(task)


def _text_of(value: Any) -> str:
    """Return a pickle of ours as a text, for workers."""
    return base64.b64encode(pickle.dumps(value)).decode("ascii")


def _search_path() -> dict[str, str]:
    """Have the client find the same packages. The folder that a command is given in is none of them."""
    return {"PYTHONPATH": os.pathsep.join(one for one in sys.path if one)}


def _require_fit(ready: _Ready, address: str, store: RecordingStore) -> None:
    """Raise UnusableClusterError where the workers cannot do what those of the service do."""
    if not ready.threads:
        raise UnusableClusterError(
            f"--scheduler {address}: expected workers, found none: start some with "
            f"dask worker {address} --nworkers auto --nthreads 1"
        )
    many = [worker for worker, count in ready.threads.items() if count != 1]
    if many:
        raise UnusableClusterError(
            f"worker {_shown(many[0])}: expected one thread, found {ready.threads[many[0]]}: start it with "
            "--nthreads 1"
        )
    expected = software()
    for worker in ready.threads:
        found = _description(ready.descriptions.get(worker))
        if found is None or found.software != expected:
            other = "no such software" if found is None else _shown(", ".join(found.software))
            raise UnusableClusterError(
                f"worker {_shown(worker)}: expected the software of this host, {', '.join(expected)}, found "
                f"{other}: install the same there"
            )
        if found.problem is not None:
            raise UnusableClusterError(
                f"worker {_shown(worker)}: expected the recordings in {store.place}, found: "
                f"{_shown(found.problem)}; it needs the same path, or the same store with an endpoint and "
                "credentials of its own"
            )


def _description(text: str | None) -> _Description | None:
    try:
        return None if text is None else _Description.model_validate_json(text)
    except ValidationError:
        return None


def _shown(text: str) -> str:
    """Return what a stranger wrote, for a line of a message."""
    return one_line(text)[:LONGEST_REASON]
