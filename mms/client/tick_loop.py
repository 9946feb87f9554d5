"""Event loops that drive the connections of all clients.

A thread of the library's own wakes 100 times a second for each connection, and takes up to 10 ms to notice an
answer. So connections have no thread: a few loops wait for all of them with epoll, and let the library read
one message (a "tick") where something has come.

A tick blocks its loop for 10 ms if nothing has come. So a connection is ticked without need only

- when the answer to a request is overdue: the library ends a request in a tick, else its caller would wait
  without end;
- 50 ms after a message that did not end the request, and a second after one that came while nothing was
  asked: the library ends an association in the tick after the one that found its message to be nonsense.

Each turn of a loop lets every connection that has something to read have one message read. So all that has
come is read, and who sends without end holds up no other by more than one message a turn.
"""

import ctypes
import select
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

from mms.binding.library import library

_LOOPS: Final = 4
"""One that is held up by a relay's half message holds up a quarter of the others, for 10 ms."""
_LONGEST_WAIT_S: Final = 0.25
"""So late a loop may notice the deadline of a request that began while it waited."""
_DEADLINE_MARGIN_S: Final = 0.02
"""The library's clock counts milliseconds."""
_OVERDUE_LOOK_S: Final = 0.01
"""So seldom a loop that hears without end looks for what is overdue."""
_EMPTY_TICK_S: Final = 0.009
"""A tick that takes longer has found nothing."""
_SECOND_LOOK_S: Final = 0.05
_IDLE_LOOK_S: Final = 1.0
"""Relays send reports all day: looked at so seldom, each takes a hundredth of its loop at most."""
_NEVER: Final = float("inf")


class TickedConnection:
    """One connection that a loop drives.

    Parameters
    ----------
    loop : TickLoop
        The loop.
    pointer : int
        Pointer to the library's IedConnection, made without a thread.
    made : socket.socket
        Its socket.
    has_closed : callable
        Tells whether the library has closed the connection.
    """

    def __init__(
        self, loop: "TickLoop", pointer: int, made: socket.socket, has_closed: Callable[[], bool]
    ) -> None:
        self.descriptor: Final = made.fileno()
        self.has_closed: Final = has_closed
        self._loop: Final = loop
        self._pointer: Final = pointer
        self._ticking = threading.Lock()
        self._is_driven = True
        self._timeout_s: float | None = None
        self._heard_s = 0.0
        self._request_due_s = _NEVER
        self._look_s = _NEVER

    @property
    def due_s(self) -> float:
        """When the connection is ticked even if nothing has come [s, monotonic]."""
        return min(self._request_due_s, self._look_s)

    @contextmanager
    def requesting(self, timeout_s: float) -> Iterator[None]:
        """See to it that the library ends a request in time, for the length of the block.

        Parameters
        ----------
        timeout_s : float
            Longest wait for an answer, as the library knows it [s].

        Yields
        ------
        None
            Nothing; the block makes the request.
        """
        before = self._timeout_s, self._request_due_s
        self._heard_s = time.monotonic()
        self._timeout_s = timeout_s
        self._request_due_s = self._heard_s + timeout_s + _DEADLINE_MARGIN_S
        self._loop.watch(self)
        try:
            yield
        finally:
            self._timeout_s, self._request_due_s = before

    def tick(self, *, heard: bool) -> None:
        """Let the library read what has come, and end what is overdue; the loop's thread calls it.

        Parameters
        ----------
        heard : bool
            Whether something has come.
        """
        if not self._ticking.acquire(blocking=False):  # by the thread that waits for an answer
            return
        try:
            if not self._is_driven:
                self._request_due_s = self._look_s = _NEVER
                return
            timeout_s = self._timeout_s
            self._loop.lib.IedConnection_tick(self._pointer)
            now_s = time.monotonic()
            if not heard:
                self._look_s = _NEVER
            elif timeout_s is None and self._look_s == _NEVER:
                self._look_s = now_s + _IDLE_LOOK_S
                self._loop.watch(self)
            if timeout_s is None or self._timeout_s is None:  # nothing was asked, or it is answered
                return
            if heard:
                self._heard_s = now_s
                self._request_due_s = now_s + _SECOND_LOOK_S
            else:
                overdue_s = now_s + max(_SECOND_LOOK_S, timeout_s / 4)
                self._request_due_s = max(self._heard_s + timeout_s + _DEADLINE_MARGIN_S, overdue_s)
        finally:
            self._ticking.release()

    def tick_until(self, is_answered: Callable[[], bool], timeout_s: float) -> None:
        """Read what comes on the caller's own thread, until its request is answered or the connection ends.

        That spares waking a loop and being woken by it for each part of a file. The library ends a request
        that is overdue in one of the ticks.

        Parameters
        ----------
        is_answered : callable
            Tells whether the answer has come.
        timeout_s : float
            Longest wait, which is longer than the library's own [s].
        """
        self._loop.forget(self)
        try:
            with self._ticking:
                self._tick_until(is_answered, time.monotonic() + timeout_s)
        finally:
            if not self.has_closed():
                self._loop.resume(self)

    def _tick_until(self, is_answered: Callable[[], bool], end_s: float) -> None:
        ready = select.poll()
        ready.register(self.descriptor, select.POLLIN)
        while not is_answered() and not self.has_closed():
            began_s = time.monotonic()
            if began_s > end_s:
                return
            self._loop.lib.IedConnection_tick(self._pointer)
            if time.monotonic() - began_s > _EMPTY_TICK_S and not is_answered():
                ready.poll(1000 * _LONGEST_WAIT_S)

    def stop(self) -> None:
        """Drive the connection no longer. No tick is under way afterwards; the library may be destroyed."""
        self._loop.forget(self)
        with self._ticking:
            self._is_driven = False


class TickLoop:
    """A thread that ticks connections when something has come to them.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    name : str
        Name of the thread.
    """

    def __init__(self, lib: ctypes.CDLL, name: str) -> None:
        self.lib: Final = lib
        self._epoll = select.epoll()
        self._lock = threading.Lock()
        self._connections: dict[int, TickedConnection] = {}
        self._watched: set[TickedConnection] = set()
        threading.Thread(target=self._run, name=name, daemon=True).start()

    def __len__(self) -> int:
        return len(self._connections)

    def drive(self, pointer: int, made: socket.socket, has_closed: Callable[[], bool]) -> TickedConnection:
        """Drive a connection from now on.

        Parameters
        ----------
        pointer : int
            Pointer to the library's IedConnection.
        made : socket.socket
            Its socket, a duplicate that stays open until the connection was stopped.
        has_closed : callable
            Tells whether the library has closed the connection.

        Returns
        -------
        TickedConnection
            The connection, to be stopped before it is destroyed.
        """
        connection = TickedConnection(self, pointer, made, has_closed)
        self.resume(connection)
        return connection

    def resume(self, connection: TickedConnection) -> None:
        """Tick a connection again that was forgotten.

        Parameters
        ----------
        connection : TickedConnection
            The connection.
        """
        with self._lock:
            self._connections[connection.descriptor] = connection
            self._epoll.register(connection.descriptor, select.EPOLLIN)

    def forget(self, connection: TickedConnection) -> None:
        """Tick a connection no more; a second call does nothing.

        Parameters
        ----------
        connection : TickedConnection
            The connection.
        """
        with self._lock:
            self._watched.discard(connection)
            if self._connections.get(connection.descriptor) is connection:
                del self._connections[connection.descriptor]
                self._epoll.unregister(connection.descriptor)

    def watch(self, connection: TickedConnection) -> None:
        """Heed when a connection is due, for as long as it is at all.

        Parameters
        ----------
        connection : TickedConnection
            The connection.
        """
        with self._lock:
            self._watched.add(connection)

    def _run(self) -> None:
        looked_s = 0.0
        while True:
            # The parts of a file come close together: how long to wait is worked out only when none is there.
            heard = self._epoll.poll(0) or self._epoll.poll(self._wait_s())
            for descriptor, _events in heard:
                self._tick(self._connections.get(descriptor), heard=True)
            now_s = time.monotonic()
            if not heard or now_s - looked_s >= _OVERDUE_LOOK_S:
                looked_s = now_s
                for connection in self._overdue(now_s):
                    self._tick(connection, heard=False)

    def _tick(self, connection: TickedConnection | None, *, heard: bool) -> None:
        if connection is None:  # forgotten meanwhile
            return
        connection.tick(heard=heard)
        if connection.has_closed():
            self.forget(connection)

    def _wait_s(self) -> float:
        with self._lock:
            self._watched = {each for each in self._watched if each.due_s < _NEVER}
            due_s = min((each.due_s for each in self._watched), default=_NEVER)
        return min(max(due_s - time.monotonic(), 0.0), _LONGEST_WAIT_S)

    def _overdue(self, now_s: float) -> list[TickedConnection]:
        with self._lock:
            return [each for each in self._watched if each.due_s <= now_s]


_starting: Final = threading.Lock()
_loops: Final[list[TickLoop]] = []


def least_busy_loop() -> TickLoop:
    """Choose a loop for one more connection; the first call starts them.

    Returns
    -------
    TickLoop
        The one with the fewest connections.
    """
    with _starting:
        if not _loops:
            _loops.extend(TickLoop(library(), f"mms-client-{number}") for number in range(_LOOPS))
    return min(_loops, key=len)
