"""Connections that came and are yet to be served, with requests for /healthz in front.

The system keeps new connections in the order in which they came. In a crowd of thousands a request for
/healthz would wait until all before it are served. Here they are all accepted at once, which takes some
microseconds each, and a few are served in each turn of the event loop.
"""

import asyncio
import errno
import socket
from collections import deque
from collections.abc import Callable, Coroutine

from service.process.tally import Tally

ACCEPTED_AT_ONCE = 256
"""Connections between two looks at anything else."""

SERVED_AT_ONCE = 4
"""So few that who is served in a turn, and asks for little, is answered some milliseconds later."""

LOOKED_AT_AT_ONCE = 256
"""Clients that had sent nothing are looked at again, so many in a turn."""

URGENT = (b"GET /healthz", b"HEAD /health")
"""First octets of such requests, of one length."""

PAUSE_S = 1.0
"""Where this process may open nothing more."""

OUT_OF_RESOURCES = {errno.EMFILE, errno.ENFILE, errno.ENOBUFS, errno.ENOMEM}
GONE = {errno.ECONNABORTED, errno.EPROTO, errno.EPERM, errno.ETIMEDOUT}
"""The client has given up, or a filter refused it."""

Serve = Callable[[socket.socket], Coroutine[None, None, None]]


class ConnectionQueue:
    """Accepts the connections of one listening socket, in the running event loop, until it is closed.

    serve: makes a connection one of the server's. most: those that wait at a time; others wait in the system.
    """

    def __init__(self, listener: socket.socket, serve: Serve, *, most: int, tally: Tally) -> None:
        self._loop = asyncio.get_running_loop()
        self._listener = listener
        self._serve = serve
        self._most = most
        self._tally = tally
        self._urgent: deque[socket.socket] = deque()
        self._waiting: deque[socket.socket] = deque()
        self._silent: deque[socket.socket] = deque()
        self._serving: set[asyncio.Task[None]] = set()
        self._is_scheduled = False
        self._is_open = True
        listener.setblocking(False)  # noqa: FBT003 - the standard library's
        self._loop.add_reader(listener, self._accept)

    def close(self) -> None:
        """Accept no more, and close the connections that wait."""
        self._is_open = False
        self._loop.remove_reader(self._listener)
        for connection in (*self._urgent, *self._waiting, *self._silent):
            connection.close()

    def _number(self) -> int:
        return len(self._urgent) + len(self._waiting) + len(self._silent)

    def _accept(self) -> None:
        for _ in range(ACCEPTED_AT_ONCE):
            if self._number() >= self._most:
                self._loop.remove_reader(self._listener)  # until some are served
                break
            try:
                connection, _address = self._listener.accept()
            except (BlockingIOError, InterruptedError):
                break
            except OSError as error:
                if error.errno in GONE:
                    continue
                if error.errno not in OUT_OF_RESOURCES:
                    raise
                self._tally.add("not_accepted")
                self._loop.remove_reader(self._listener)
                self._loop.call_later(PAUSE_S, self._go_on)
                break
            connection.setblocking(False)  # noqa: FBT003 - the standard library's
            self._put(connection)
        self._schedule()

    def _go_on(self) -> None:
        if self._is_open:
            self._loop.add_reader(self._listener, self._accept)

    def _put(self, connection: socket.socket) -> None:
        first = _first_bytes(connection)
        if first is None:
            self._silent.append(connection)
        else:
            (self._urgent if first in URGENT else self._waiting).append(connection)

    def _schedule(self) -> None:
        if self._number() and not self._is_scheduled:
            self._is_scheduled = True
            self._loop.call_soon(self._serve_some)

    def _serve_some(self) -> None:
        self._is_scheduled = False
        if not self._is_open:
            return
        was_full = self._number() >= self._most
        for _ in range(min(LOOKED_AT_AT_ONCE, len(self._silent))):
            self._put(self._silent.popleft())
        for _ in range(SERVED_AT_ONCE):
            queue = self._urgent or self._waiting or self._silent
            if not queue:
                break
            task = self._loop.create_task(self._serve(queue.popleft()))
            self._serving.add(task)
            task.add_done_callback(self._serving.discard)
        if was_full:
            self._go_on()
        self._schedule()


def _first_bytes(connection: socket.socket) -> bytes | None:
    """Return what a client has sent first, and leave it to be read; None where it has sent nothing."""
    try:
        return connection.recv(len(URGENT[0]), socket.MSG_PEEK)
    except (BlockingIOError, InterruptedError):
        return None
    except OSError:
        return b""  # it is gone, as whoever serves it will see
