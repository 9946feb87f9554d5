"""Keeps the collector process running. A crash in the C library costs a restart, not the service."""

import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from threading import Event, Lock, Thread

import structlog

from service.configuration.settings import Settings

log = structlog.get_logger(__name__)

COMMAND = (sys.executable, "-m", "service.collector")
SHORTEST_DELAY_S, LONGEST_DELAY_S = 0.2, 30.0
STABLE_AFTER_S = 60.0
STOP_PATIENCE_S = 5.0

PIPE_BYTES = 1024**2
"""Room for the settings of a few thousand relays: the system's usual 64 kB would be too little for 200."""


def _nothing(_exit_code: int | None) -> None:
    """For a collector whose end nobody needs to know."""


class GatewaySupervisor:
    """Starts the collector as a child process, and starts it again when it ends.

    The child reads its settings from its standard input and ends when that closes: it cannot outlive this
    process, however this process dies, and no setting appears in a command line or an environment.
    """

    def __init__(
        self,
        settings: Settings,
        command: tuple[str, ...] = COMMAND,
        *,
        number: int = 0,
        on_end: Callable[[int | None], None] = _nothing,
    ) -> None:
        """`number`: its own among the collectors of one service.  on_end: called after each of its ends.

        It is given the exit code, None where the collector did not start.
        """
        self._settings = settings
        self._command = (*command, str(number))
        self._on_end = on_end
        self._lock = Lock()
        self._stopping = Event()
        self._child: subprocess.Popen[bytes] | None = None
        self._thread = Thread(target=self._run, name="collector-supervisor", daemon=True)

    @property
    def process_id(self) -> int | None:
        """Of the running collector; None while there is none."""
        child = self._child
        return child.pid if child is not None and child.poll() is None else None

    def problem(self) -> str | None:
        """Why nothing is collected at present; None while all is well."""
        return "the collector process is not running" if self.process_id is None else None

    def start(self) -> None:
        self._thread.start()

    def ask_to_end(self) -> None:
        """Ask the collector to end, and wait for nothing. Safe to call twice."""
        with self._lock:
            self._stopping.set()
            if self._child is not None:
                _close_input(self._child)

    def stop(self) -> None:
        """Ask the collector to end, wait for it, kill it if it does not go. Safe to call twice."""
        self.ask_to_end()
        child = self._child
        if child is None:
            return
        try:
            child.wait(STOP_PATIENCE_S)
        except subprocess.TimeoutExpired:
            log.warning("the collector did not end by itself and is killed")
            child.kill()
        self._thread.join()

    def _run(self) -> None:
        delay_s = SHORTEST_DELAY_S
        while not self._stopping.is_set():
            started_s = time.monotonic()
            exit_code = None
            try:
                exit_code = self._run_once()
                ended = f"exit code {exit_code}"
            except OSError as error:  # no process or memory left at the moment
                ended = f"it does not start: {error}"
            self._on_end(exit_code)
            if self._stopping.is_set():
                return
            if time.monotonic() - started_s > STABLE_AFTER_S:
                delay_s = SHORTEST_DELAY_S
            log.error("the collector ended and is started again", reason=ended, delay_s=delay_s)
            self._stopping.wait(delay_s)
            delay_s = min(2 * delay_s, LONGEST_DELAY_S)

    def _run_once(self) -> int | None:
        """One collector from start to end. Returns its exit code, None when none is wanted any more."""
        with self._lock:
            if self._stopping.is_set():
                return None
            child = self._child = subprocess.Popen(  # noqa: S603 - our own module
                self._command,
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                pipesize=PIPE_BYTES,
            )
            # Before anybody may close that pipe. One line fits into it, so this waits for no child.
            _hand_over(child, self._settings)
        exit_code = child.wait()
        with self._lock:
            _close_input(child)
        return exit_code


def _hand_over(child: subprocess.Popen[bytes], settings: Settings) -> None:
    assert child.stdin is not None  # noqa: S101 - it was opened as a pipe
    # A child that is dead already reports itself by its exit code.
    with suppress(BrokenPipeError):
        child.stdin.write(settings.model_dump_json().encode() + b"\n")
        child.stdin.flush()


def _close_input(child: subprocess.Popen[bytes]) -> None:
    assert child.stdin is not None  # noqa: S101 - it was opened as a pipe
    with suppress(BrokenPipeError):
        child.stdin.close()
