"""What was done when, for whoever has to find out why."""

import time
from threading import Lock

AROUND_S = 20.0


class History:
    """Lines with their time since the beginning of the schedule; safe for several threads."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._lines: list[tuple[float, str]] = []
        self.begin()

    def begin(self) -> None:
        """Time zero is now."""
        self._began_s = time.monotonic()
        self._began_ns = time.time_ns()

    def note(self, line: str) -> None:
        at_s = time.monotonic() - self._began_s
        with self._lock:
            self._lines.append((at_s, line))

    def lines(self) -> list[str]:
        with self._lock:
            return [_told(*line) for line in self._lines]

    def around(self, time_ns: int | None) -> list[str]:
        """The lines shortly before and after a time; the last ones where it is not known."""
        with self._lock:
            if time_ns is None:
                return [_told(*line) for line in self._lines[-10:]]
            at_s = (time_ns - self._began_ns) * 1e-9
            return [_told(*line) for line in self._lines if abs(line[0] - at_s) < AROUND_S]


def _told(at_s: float, line: str) -> str:
    return f"{at_s:7.1f} s  {line}"
