"""The order in which the threads of a process write to a database that has one writer."""

from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Lock

from sqlalchemy.exc import TimeoutError  # noqa: A004 - that of the database


class Turns:
    """One thread at a time, in the order they came, or ahead of those that wait.

    What has to be written in time goes ahead: a gateway that has just connected 250 relays has as many
    threads with something to write, and would else renew its leases too late. A lock alone keeps no order:
    of hundreds that wait for one, some wait for half a minute.
    """

    def __init__(self, timeout_s: float) -> None:
        """Let nobody wait for longer than `timeout_s`."""
        self._timeout_s = timeout_s
        self._guard = Lock()
        self._is_taken = False
        self._waiting: deque[Lock] = deque()
        """A lock for each thread that waits, released when its turn comes."""

    @contextmanager
    def one(self, *, ahead: bool) -> Iterator[None]:
        """Have a turn while the block runs. Raises sqlalchemy.exc.TimeoutError."""
        self._take(ahead=ahead)
        try:
            yield
        finally:
            self._pass_on()

    def _take(self, *, ahead: bool) -> None:
        with self._guard:
            if not self._is_taken:
                self._is_taken = True
                return
            own = Lock()
            own.acquire()
            if ahead:
                self._waiting.appendleft(own)
            else:
                self._waiting.append(own)
        if own.acquire(timeout=self._timeout_s):
            return
        with self._guard:
            if own in self._waiting:  # else the turn came just now
                self._waiting.remove(own)
                raise TimeoutError(f"other threads have been writing for {self._timeout_s:g} s")

    def _pass_on(self) -> None:
        with self._guard:
            if self._waiting:
                self._waiting.popleft().release()
            else:
                self._is_taken = False
