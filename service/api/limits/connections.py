"""HTTP connections with limits: how long each may keep the service waiting, and how many there may be.

uvicorn closes a connection that is idle between two requests. It waits for ever for the header of the first
one, for a body, and for a client to take its answer. Here every wait for a client has a limit. When there are
as many connections as there may be, those that have kept the service waiting for longest make room. Addresses
that have no more than an equal share of the connections keep theirs.
"""

import asyncio
import fcntl
import logging
import struct
import termios
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum
from http import HTTPStatus
from itertools import islice
from operator import itemgetter
from typing import Any

import h11
from uvicorn import Config
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.server import ServerState

from service.api.problems import problem_response
from service.process.tally import Tally

STEP_BYTES = 1 << 14
"""A transfer gets its time anew with so many bytes."""

EXTRA = 64
"""Connections beyond the limit that are let in for /healthz, while all others are being answered."""

DISPLACED_AT_ONCE = 16
"""As many make room together, so that a flood of connections costs one look at all of them for so many."""

SETTLED_S = 0.25
"""A client that has kept the service waiting for less has probably sent already what it has to send."""

UNREAD_BYTES = 1 << 20
"""So much of a body may still come after its request has been answered; then the connection is closed."""

UNREAD = struct.Struct("i")
"""The number of bytes that the system tells (FIONREAD)."""

OVERLOADED = "as many connections are open as there may be; try again"


@dataclass(frozen=True, slots=True)
class ConnectionLimits:
    """most: connections at a time. waiting: accepted, and yet to be served. The times are the settings'."""

    most: int
    header_timeout_s: float
    transfer_timeout_s: float
    idle_timeout_s: float
    waiting: int = 2048


class Wait(Enum):
    """What the service waits for. The value names it in the log, where it took too long."""

    HEADER = "slow_headers"
    BODY = "slow_bodies"
    TAKING = "answers_not_taken"
    NEXT_REQUEST = "idle"


class OpenConnections(ServerState):
    """All connections of a server, and what happened to those that were closed for the sake of others."""

    def __init__(self, limits: ConnectionLimits) -> None:
        super().__init__()
        self.limits = limits
        self.tally = Tally("connections were closed or refused")

    def admit(self, new: "LimitedConnection") -> None:
        """Make room for a new connection if there are too many, or close it where no other can be."""
        if len(self.connections) <= self.limits.most:
            return
        now_s = new.loop.time()
        present = [each for each in self._limited() if not each.is_gone()]
        surplus = len(present) - self.limits.most
        if surplus <= 0:
            return
        least_s = SETTLED_S if surplus <= EXTRA else 0.0
        crowded = self._crowded(present)
        waits = [
            (waited_s, each)
            for each in present
            if each is not new
            and each.address() in crowded
            and (waited_s := each.waited_s(now_s)) is not None
            and waited_s >= least_s
        ]
        waits.sort(key=itemgetter(0), reverse=True)
        at_once = min(DISPLACED_AT_ONCE, 1 + len(waits) // 2)
        displaced = list(islice((each for _, each in waits if not each.has_sent_more()), at_once))
        for each in displaced:
            self.tally.add("displaced")
            each.give_up(HTTPStatus.SERVICE_UNAVAILABLE, OVERLOADED)
        if surplus > EXTRA and not displaced and new.address() in crowded:
            self.tally.add("refused")
            new.give_up(HTTPStatus.SERVICE_UNAVAILABLE, OVERLOADED)

    def close_overdue(self, now_s: float) -> None:
        """Close the connections whose clients took longer than they may."""
        for connection in list(self._limited()):
            connection.close_if_overdue(now_s)

    def is_crowded(self, address: str) -> bool:
        """Tell whether an address has more than an equal share of the connections."""
        return address in self._crowded(each for each in self._limited() if not each.is_gone())

    def _crowded(self, present: Iterable["LimitedConnection"]) -> set[str]:
        connections_of = Counter(each.address() for each in present)
        return {
            address
            for address, connections in connections_of.items()
            if connections * len(connections_of) > self.limits.most
        }

    def _limited(self) -> Iterable["LimitedConnection"]:
        return (each for each in self.connections if isinstance(each, LimitedConnection))


class LimitedConnection(H11Protocol):
    """One HTTP/1.1 connection that measures how long its client keeps the service waiting."""

    def __init__(
        self,
        config: Config,
        server_state: ServerState,
        app_state: dict[str, Any],
        _loop: asyncio.AbstractEventLoop | None = None,
    ) -> None:
        super().__init__(config, server_state, app_state, _loop)
        if not isinstance(server_state, OpenConnections):
            raise TypeError("expected the server to have OpenConnections")
        self.logger = _quiet_logger()
        self._open = server_state
        self._header_begun = True  # a new connection has to send one, also its first byte
        self.wait: Wait | None = Wait.HEADER
        self._since_s = self.loop.time()
        self._received_bytes = 0
        self._unread_bytes = 0
        self._left_bytes = 0

    def address(self) -> str:
        """Return the address of the client's machine; "" on a socket that has none."""
        return self.client[0] if self.client else ""

    def is_gone(self) -> bool:
        """Tell whether the connection is closed, but for asyncio's next turn."""
        return self.transport.is_closing() and self.transport.get_write_buffer_size() == 0

    def waited_s(self, now_s: float) -> float | None:
        """Return for how long the client has kept the service waiting [s]; None while the service works."""
        return None if self.wait is None else now_s - self._since_s

    def has_sent_more(self) -> bool:
        """Tell whether bytes of the client lie in the system that the service did not come to read yet.

        Such a client waits for the service, however long ago the service began to wait for it. One that does
        not take its answers is not read, so what it has sent counts for nothing.
        """
        if self.wait is Wait.TAKING or self.transport.is_closing():
            return False
        connection = self.transport.get_extra_info("socket")
        (unread_bytes,) = UNREAD.unpack(fcntl.ioctl(connection, termios.FIONREAD, bytes(UNREAD.size)))
        return bool(unread_bytes > 0)

    def close_if_overdue(self, now_s: float) -> None:
        """Close the connection if its client has taken longer than it may."""
        self._look()
        limits = self._open.limits
        limit_s = {
            Wait.HEADER: limits.header_timeout_s,
            Wait.NEXT_REQUEST: limits.idle_timeout_s,
        }.get(self.wait or Wait.BODY, limits.transfer_timeout_s)
        waited_s = self.waited_s(now_s)
        if self.wait is None or waited_s is None or waited_s <= limit_s or self.has_sent_more():
            return
        if self.wait is not Wait.NEXT_REQUEST:
            self._open.tally.add(self.wait.value)
        self.give_up(HTTPStatus.REQUEST_TIMEOUT, f"the request was not complete in time ({limit_s:g} s)")

    def give_up(self, status: HTTPStatus, detail: str) -> None:
        """Close the connection. A client that may still expect an answer gets this one."""
        if self.transport.is_closing() or self.wait is Wait.TAKING:
            self.transport.abort()
            return
        answers = self.cycle is not None and not self.cycle.response_complete
        if answers and self.cycle.response_started:
            self.transport.abort()
            return
        if answers or self.wait is Wait.HEADER:
            if answers:
                self.cycle.disconnected = True  # what the application would still answer goes nowhere
            self.transport.write(_answer(status, detail))
        self.transport.close()
        self._look()

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]  # as uvicorn has it
        super().connection_made(transport)
        self._open.admit(self)

    def data_received(self, data: bytes) -> None:
        self._header_begun = True
        self._received_bytes += len(data)
        super().data_received(data)
        if self._is_dropping_a_body():
            self._unread_bytes += len(data)
            if self._unread_bytes > UNREAD_BYTES:
                self._open.tally.add("bodies_not_read")
                self.transport.close()
        self._look()

    def on_response_complete(self) -> None:
        self._unread_bytes = 0
        super().on_response_complete()
        self._header_begun = bool(self.conn.trailing_data[0])
        self._look()

    def send_400_response(self, msg: str) -> None:
        """Answer what is no HTTP, with a problem document."""
        self._open.tally.add("invalid_requests")
        self.transport.write(_answer(HTTPStatus.BAD_REQUEST, msg))
        self.transport.close()

    def _unsupported_upgrade_warning(self) -> None:
        """Say nothing: the request is answered as if it asked for no upgrade, as RFC 9110 wants it."""

    def _is_dropping_a_body(self) -> bool:
        """Tell whether the request was answered without its body, which nobody reads any more."""
        return self.conn.our_state is h11.DONE and self.conn.their_state is h11.SEND_BODY

    def _look(self) -> None:
        """Note what the service waits for, and since when."""
        now_s = self.loop.time()
        wait = self._present_wait()
        left_bytes = self.transport.get_write_buffer_size() if wait is Wait.TAKING else 0
        moves_on = (
            self._received_bytes >= STEP_BYTES
            if wait is Wait.BODY
            else wait is Wait.TAKING and left_bytes <= self._left_bytes - STEP_BYTES
        )
        if wait is not self.wait or moves_on:
            self.wait = wait
            self._since_s = now_s
            self._received_bytes = 0
            self._left_bytes = left_bytes

    def _present_wait(self) -> Wait | None:
        if self.transport.is_closing() or self.flow.write_paused:
            return Wait.TAKING
        if self.conn.their_state is h11.IDLE:
            return Wait.HEADER if self._header_begun else Wait.NEXT_REQUEST
        if self.conn.their_state is not h11.SEND_BODY or self.flow.read_paused:
            return None
        return None if self.cycle.waiting_for_100_continue else Wait.BODY


def _answer(status: HTTPStatus, detail: str) -> bytes:
    """Return a whole answer with a problem document, for a connection that is closed after it."""
    response = problem_response("", status, detail, headers={"Connection": "close"})
    headers = b"".join(b"%s: %s\r\n" % header for header in response.raw_headers)
    return b"HTTP/1.1 %d %s\r\n%s\r\n%s" % (status, status.phrase.encode(), headers, bytes(response.body))


def _quiet_logger() -> logging.Logger:
    """Return uvicorn's log without its warnings, of which there is one for each bad request."""
    logger = logging.getLogger("uvicorn.error.connection")
    logger.setLevel(logging.ERROR)
    return logger
