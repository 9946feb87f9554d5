"""Keep one process of the service running. A crash in it costs a restart, not the service."""

import os
import signal
import subprocess
import time
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from threading import Event, Lock, Thread
from typing import IO

import structlog

from service.configuration.environment import environment_with
from service.configuration.settings import Settings
from service.process.termination import held_back
from service.timing.backoff import PROCESS_BACKOFF, STABLE_AFTER_S, Backoff, RestartDelay

log = structlog.get_logger(__name__)

PIPE_BYTES = 1024**2
"""Room for the settings of a few thousand relays: the system's usual 64 kB would be too little for 200."""

LONGEST_LINE = 4096
"""Bytes of what a process says in one line; the rest is taken for another line."""


@dataclass(frozen=True, slots=True)
class RestartPolicy:
    """Say when a process that ended is started again, and how long one may take to end.

    backoff: the pauses before further starts.  stable_after_s: a process that ran for longer than this ran
    well, and the next pause is the first one again.  stop_timeout_s: a process that takes longer to end is
    killed.
    """

    backoff: Backoff = PROCESS_BACKOFF
    stable_after_s: float = STABLE_AFTER_S
    stop_timeout_s: float = 5.0


RESTART_POLICY = RestartPolicy()


def _ignore(_exit_code: int | None) -> None:
    """Do nothing about the end of a process."""


class SupervisedProcess:
    """Start a child process, and start it again when it ends.

    The child reads its settings from its standard input and ends when that closes: it cannot outlive this
    process, however this process dies, and no setting appears in a command line or an environment. What else
    it needs is in a file without a name that it inherits: a pipe would have to be read before it takes more.
    service.supervision.child is its half.
    """

    def __init__(
        self,
        name: str,
        command: tuple[str, ...],
        settings: Settings,
        *,
        handed: bytes = b"",
        secrets: Collection[str] = (),
        policy: RestartPolicy = RESTART_POLICY,
        on_exit: Callable[[int | None], None] = _ignore,
        on_line: Callable[[bytes], None] | None = None,
    ) -> None:
        """Prepare the thread that keeps the process running.

        name: what people call it, with an article.

        handed: what each child gets besides its settings, of any size.

        secrets: beginnings of the names of the variables that the child gets of the service's own.

        on_exit: called after each end of the process with its exit code; None where it did not start.

        on_line: called with each line of the child's standard output; None where nothing is heard of that.
        """
        self._name = name
        self._command = command
        self._settings = settings
        self._handed = handed
        self._secrets = secrets
        self._policy = policy
        self._on_exit = on_exit
        self._on_line = on_line
        self._lock = Lock()
        self._stopping = Event()
        self._child: subprocess.Popen[bytes] | None = None
        self._thread = Thread(target=self._run, name=f"supervisor of {name}", daemon=True)

    @property
    def process_id(self) -> int | None:
        """Return the process id of the running child; None while there is none."""
        child = self._child
        return child.pid if child is not None and child.poll() is None else None

    def problem(self) -> str | None:
        """Return that the process is not running at present; None while it is."""
        return f"{self._name} is not running" if self.process_id is None else None

    def start(self) -> None:
        """Start the process, and the thread that keeps it running."""
        self._thread.start()

    def ask_to_end(self) -> None:
        """Ask the process to end, and wait for nothing. Safe to call twice."""
        with self._lock:
            self._stopping.set()
            if self._child is not None:
                _close_input(self._child)

    def stop(self) -> None:
        """Ask the process to end, wait for it, kill it if it does not end in time. Safe to call twice."""
        self.ask_to_end()
        child = self._child
        if child is not None:
            try:
                child.wait(self._policy.stop_timeout_s)
            except subprocess.TimeoutExpired:
                log.warning("a process did not end by itself and is killed", process=self._name)
                child.kill()
        if self._thread.ident is not None:
            self._thread.join()

    def _run(self) -> None:
        """Run one process after the other, with pauses between them, until no more is wanted."""
        delay = RestartDelay(self._policy.backoff, stable_after_s=self._policy.stable_after_s)
        while not self._stopping.is_set():
            started_s = time.monotonic()
            exit_code = None
            try:
                exit_code = self._run_once()
                ended = f"exit code {exit_code}"
            except OSError as error:  # no process or memory left at the moment
                ended = f"it does not start: {error}"
            lasted_s = time.monotonic() - started_s
            try:
                self._on_exit(exit_code)
            except Exception:  # the process is started again whatever goes wrong in between
                log.exception("what is done after a process's end failed", process=self._name)
            if self._stopping.is_set():
                return
            delay_s = delay.after_run_s(lasted_s)
            log.error(
                "a process ended and is started again", process=self._name, reason=ended, delay_s=delay_s
            )
            self._stopping.wait(delay_s)

    def _run_once(self) -> int | None:
        """Run one process from start to end. Returns its exit code; None when none is wanted any more."""
        with self._lock:
            if self._stopping.is_set():
                return None
            with _held(self._handed) as inherited:
                with held_back(signal.SIGINT, signal.SIGTERM):  # until the process ignores them
                    child = self._child = subprocess.Popen(  # noqa: S603 - our own module
                        self._command,
                        stdin=subprocess.PIPE,
                        stdout=subprocess.DEVNULL if self._on_line is None else subprocess.PIPE,
                        pipesize=PIPE_BYTES,
                        pass_fds=inherited,
                        env=environment_with(self._secrets),
                    )
                # This is sent before anybody may close that pipe. It fits into it, so this never waits.
                _send_settings(child, self._settings, inherited)
        if child.stdout is not None:
            self._hear(child.stdout)
        exit_code = child.wait()
        with self._lock:
            _close_input(child)
        return exit_code

    def _hear(self, output: IO[bytes]) -> None:
        """Pass on each line that the child writes, until it closes its output."""
        assert self._on_line is not None  # noqa: S101 - else the output is no pipe
        with output:
            while line := output.readline(LONGEST_LINE):
                try:
                    self._on_line(line)
                except Exception:  # a bug in whoever hears it must not let the child fill its pipe and wait
                    log.exception("what a process says was not understood", process=self._name)


@contextmanager
def _held(content: bytes) -> Iterator[tuple[int, ...]]:
    """Hold the content in a file of memory without a name, and yield its descriptor; none without content."""
    if not content:
        yield ()
        return
    with os.fdopen(os.memfd_create("handed over"), "wb") as file:
        file.write(content)
        file.flush()
        yield (file.fileno(),)


def _send_settings(child: "subprocess.Popen[bytes]", settings: Settings, inherited: tuple[int, ...]) -> None:
    """Write two lines to the input of a child: the settings, and the descriptor that it inherits, if any."""
    assert child.stdin is not None  # noqa: S101 - it was opened as a pipe
    # A child that is dead already reports itself by its exit code.
    with suppress(BrokenPipeError):
        child.stdin.write(settings.model_dump_json().encode() + b"\n")
        child.stdin.write(b"".join(b"%d" % descriptor for descriptor in inherited) + b"\n")
        child.stdin.flush()


def _close_input(child: "subprocess.Popen[bytes]") -> None:
    """Close the input of a child, which ends it."""
    assert child.stdin is not None  # noqa: S101 - it was opened as a pipe
    with suppress(BrokenPipeError):
        child.stdin.close()
