"""The process that accepts connections: it answers /healthz, and hands all others to the service in turn.

In a crowd of thousands a request for /healthz would wait until all before it are served, and for each turn
of an event loop that shares one interpreter with threads at work. This process only looks at what clients
send first, so that it comes to /healthz within milliseconds. It answers there while the event loop of the
service sends signs of life. Otherwise the request waits for the service, as all others do.

It runs no code of the application and has no setting, no secret and no variable: only the socket that
listens, and another to the service. It cannot read requests over TLS, which are all handed on.
"""

import errno
import os
import selectors
import signal
import socket
import sys
import time
from collections import deque

from service.process.capabilities import keep_only

HANDED_AT_ONCE = 4
"""So few that who is served in a turn of the service's event loop is answered soon."""

ACCEPTED_AT_ONCE = 256
"""Connections between two looks at anything else."""

SILENT_S = 1.0
"""Who has sent nothing for so long is the service's to wait for."""

STILL_ALIVE_S = 10.0
"""A service that has sent no sign of life for longer is not told to be alive."""

PAUSE_S = 0.1
"""Where nothing more may be opened, here or in the service."""

HEADER_BYTES = 4096
"""A longer header is no ordinary question for /healthz."""

HANDED = b"."
REFUSED = b"!"
"""Octets of a message to the service: one for each connection, or that some could not be accepted."""

REQUESTS = tuple(
    f"{method} /healthz HTTP/{version}".encode() for method in ("GET", "HEAD") for version in ("1.1", "1.0")
)
PLAIN_HEADERS = {
    b"accept",
    b"accept-encoding",
    b"accept-language",
    b"authorization",
    b"cache-control",
    b"connection",
    b"host",
    b"pragma",
    b"user-agent",
}
"""The answer depends on none of them. A request with any other (Origin) is the service's to answer."""

OUT_OF_RESOURCES = {errno.EMFILE, errno.ENFILE, errno.ENOBUFS, errno.ENOMEM}
GONE = {errno.ECONNABORTED, errno.EPROTO, errno.EPERM, errno.ETIMEDOUT}
"""The client has given up, or a filter refused it."""
CLOGGED = {errno.EAGAIN, errno.ETOOMANYREFS, *OUT_OF_RESOURCES}
"""The service has enough to do, or the system has no more descriptors on their way."""


class Acceptor:
    """Accepts from `listener` and hands over to `service`; most: connections that wait here at a time."""

    def __init__(self, listener: socket.socket, service: socket.socket, most: int) -> None:
        self._listener = listener
        self._service = service
        self._most = most
        self._selector = selectors.DefaultSelector()
        self._waiting: deque[socket.socket] = deque()
        self._silent_since_s: dict[socket.socket, float] = {}
        self._paused_until_s = 0.0
        self._health = b""
        self._sign_of_life_s = 0.0
        for each in (listener, service):
            each.setblocking(False)  # noqa: FBT003 - the standard library's
        self._selector.register(service, selectors.EVENT_READ)

    def run(self) -> None:
        """Accept until the service ends."""
        while True:
            self._watch()
            for key, _ in self._selector.select(self._patience_s()):
                if key.fileobj is self._listener:
                    self._accept()
                elif key.fileobj is not self._service:
                    self._look_again(key.fileobj)  # type: ignore[arg-type]  # a socket, as was registered
                elif not self._hear():
                    return
            self._give_silent_ones_up()
            self._hand_over()

    def _watch(self) -> None:
        """Look at the listening socket while there is room, and at the service's when it has to take some."""
        paused = time.monotonic() < self._paused_until_s
        has_room = len(self._waiting) + len(self._silent_since_s) < self._most
        is_watched = self._listener in self._selector.get_map()
        if has_room and not paused and not is_watched:
            self._selector.register(self._listener, selectors.EVENT_READ)
        elif is_watched and (paused or not has_room):
            self._selector.unregister(self._listener)
        writes = selectors.EVENT_WRITE if self._waiting and not paused else 0
        self._selector.modify(self._service, selectors.EVENT_READ | writes)

    def _patience_s(self) -> float | None:
        """Return after how long there is something to do though no socket has anything new."""
        now_s = time.monotonic()
        ends_s = [each + SILENT_S for each in list(self._silent_since_s.values())[:1]]
        if now_s < self._paused_until_s:
            ends_s.append(self._paused_until_s)
        return max(min(ends_s) - now_s, 0.0) if ends_s else None

    def _accept(self) -> None:
        for _ in range(min(ACCEPTED_AT_ONCE, self._most - len(self._waiting) - len(self._silent_since_s))):
            try:
                connection, _address = self._listener.accept()
            except (BlockingIOError, InterruptedError):
                return
            except OSError as error:
                if error.errno in GONE:
                    continue
                if error.errno not in OUT_OF_RESOURCES:
                    raise
                self._paused_until_s = time.monotonic() + PAUSE_S
                self._send(REFUSED, [])
                return
            connection.setblocking(False)  # noqa: FBT003 - the standard library's
            if not self._place(connection):
                self._silent_since_s[connection] = time.monotonic()
                self._selector.register(connection, selectors.EVENT_READ)

    def _place(self, connection: socket.socket) -> bool:
        """Answer a connection, or have it wait for the service; False where it has sent nothing yet."""
        try:
            first = connection.recv(HEADER_BYTES, socket.MSG_PEEK)
        except (BlockingIOError, InterruptedError):
            return False
        except OSError:
            first = b""
        if not first:
            connection.close()
        elif self._is_alive() and asks_for_health(first):
            self._answer(connection, first)
        else:
            self._waiting.append(connection)
        return True

    def _look_again(self, connection: socket.socket) -> None:
        if self._place(connection):
            self._forget(connection)

    def _forget(self, connection: socket.socket) -> None:
        del self._silent_since_s[connection]
        self._selector.unregister(connection)

    def _is_alive(self) -> bool:
        return bool(self._health) and time.monotonic() - self._sign_of_life_s <= STILL_ALIVE_S

    def _answer(self, connection: socket.socket, request: bytes) -> None:
        date = time.strftime("date: %a, %d %b %Y %H:%M:%S GMT\r\n", time.gmtime()).encode()
        status, _, rest = self._health.partition(b"\r\n")
        answer = status + b"\r\n" + date + rest
        if request.startswith(b"HEAD"):
            answer = answer.partition(b"\r\n\r\n")[0] + b"\r\n\r\n"
        with connection:
            try:
                connection.recv(len(request))  # a socket with unread octets is reset when it is closed
                connection.send(answer)
                connection.shutdown(socket.SHUT_WR)
            except OSError:
                return  # the client has gone

    def _give_silent_ones_up(self) -> None:
        now_s = time.monotonic()
        for connection, since_s in list(self._silent_since_s.items()):
            if now_s < since_s + SILENT_S:
                break
            self._forget(connection)
            self._waiting.append(connection)

    def _hand_over(self) -> None:
        while self._waiting and time.monotonic() >= self._paused_until_s:
            handed = [self._waiting[place] for place in range(min(HANDED_AT_ONCE, len(self._waiting)))]
            if not self._send(HANDED * len(handed), handed):
                return
            for connection in handed:
                self._waiting.popleft()
                connection.close()

    def _send(self, message: bytes, connections: list[socket.socket]) -> bool:
        """Send a message to the service; False where it does not take one now."""
        try:
            socket.send_fds(self._service, [message], [each.fileno() for each in connections])
        except OSError as error:
            if error.errno not in CLOGGED:
                raise
            if error.errno != errno.EAGAIN:  # otherwise the selector tells when there is room
                self._paused_until_s = time.monotonic() + PAUSE_S
            return False
        return True

    def _hear(self) -> bool:
        """Take signs of life, the first of which is the answer of /healthz; False at the service's end."""
        while True:
            try:
                message = self._service.recv(1 << 16)
            except (BlockingIOError, InterruptedError):
                return True
            except OSError:
                return False
            if not message:
                return False
            self._health = self._health or message
            self._sign_of_life_s = time.monotonic()


def asks_for_health(request: bytes) -> bool:
    """Tell whether this is one whole plain request for /healthz, and nothing more."""
    head, end, rest = request.partition(b"\r\n\r\n")
    request_line, *headers = head.split(b"\r\n")
    if not end or rest or request_line not in REQUESTS:
        return False
    names = [header.partition(b":")[0].lower() for header in headers]
    return names.count(b"host") == 1 and PLAIN_HEADERS.issuperset(names)


def main() -> None:
    """Run in a process of its own: the descriptors of both sockets, and how many may wait, are arguments."""
    listener, service, most = (int(word) for word in sys.argv[1:])
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)  # it ends with the service
    keep_only(())
    os.chdir("/")
    try:
        Acceptor(socket.socket(fileno=listener), socket.socket(fileno=service), most).run()
    except (BrokenPipeError, ConnectionResetError):
        return  # the service has ended
