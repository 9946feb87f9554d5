"""Child processes of the demo: started, watched and ended by it."""

import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Self

STOP_TIMEOUT_S = 10.0
TAIL_LINES = 5


class ProgramError(RuntimeError):
    """A program of the demo ended, or could not start; the message has the end of its log."""


class Program:
    """One child process that writes its log to a file. Leaving the `with` block ends it."""

    def __init__(
        self,
        name: str,
        command: Sequence[str],
        log: Path,
        environment: Mapping[str, str] | None = None,
        *,
        stop_timeout_s: float = STOP_TIMEOUT_S,
    ) -> None:
        """stop_timeout_s: time to end after SIGTERM; then the program is killed."""
        self._stop_timeout_s = stop_timeout_s
        self._name = name
        self._log = log
        with log.open("wb") as sink:
            # In its own session, so that Ctrl-C reaches the demo alone, which ends its programs in order.
            self._process = subprocess.Popen(  # noqa: S603 - our own modules
                command,
                stdin=subprocess.DEVNULL,
                stdout=sink,
                stderr=subprocess.STDOUT,
                env=environment,
                start_new_session=True,
            )

    @property
    def process_id(self) -> int:
        return self._process.pid

    def logged(self) -> str:
        """Its log so far."""
        return self._log.read_text(encoding="utf-8", errors="replace")

    def has_logged(self, text: str) -> bool:
        """Whether its log contains the text."""
        return text in self.logged()

    def check(self) -> None:
        """Raise ProgramError when the program has ended."""
        exit_code = self._process.poll()
        if exit_code is not None:
            raise ProgramError(
                f"{self._name} ended (exit code {exit_code}); {self._log} says: {self._end_of_log()}"
            )

    def stop(self) -> None:
        """Ask the program to end and wait; kill it if it does not end in time."""
        if self._process.poll() is not None:
            return
        self._process.terminate()
        try:
            self._process.wait(self._stop_timeout_s)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    def _end_of_log(self) -> str:
        lines = self.logged().splitlines()
        return " | ".join(lines[-TAIL_LINES:]) or "nothing"
