"""Programs the demo runs beside itself: started, watched, and gone when the demo is."""

import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Self

STOP_PATIENCE_S = 10.0
TAIL_LINES = 5


class ProgramError(RuntimeError):
    """A program of the demo ended, or could not start; its last words are in the message."""


class Program:
    """One child process that writes its log to a file. Leaving the `with` block ends it."""

    def __init__(
        self, name: str, command: Sequence[str], log: Path, environment: Mapping[str, str] | None = None
    ) -> None:
        self._name = name
        self._log = log
        with log.open("wb") as sink:
            # Its own session: Ctrl-C is for the demo, which ends its programs in order.
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

    def has_said(self, words: str) -> bool:
        """Whether its log holds these words."""
        return words in self._log.read_text(encoding="utf-8", errors="replace")

    def check(self) -> None:
        """Raises ProgramError when the program has ended."""
        exit_code = self._process.poll()
        if exit_code is not None:
            raise ProgramError(
                f"{self._name} ended (exit code {exit_code}); {self._log} says: {self._last_words()}"
            )

    def stop(self) -> None:
        """Ask it to end, wait, kill it if it does not go."""
        if self._process.poll() is not None:
            return
        self._process.terminate()
        try:
            self._process.wait(STOP_PATIENCE_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    def _last_words(self) -> str:
        lines = self._log.read_text(encoding="utf-8", errors="replace").splitlines()
        return " | ".join(lines[-TAIL_LINES:]) or "nothing"
