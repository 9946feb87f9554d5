"""A thread that drives many servers.

libiec61850's own threads cost about 0.6 % of a core for each server; one thread over all of them costs far
less. In each round the pump polls servers for data and serves it. Then it gives one server a turn, in which
that server sends its reports.

A server is polled in every round after a request, then the more rarely the longer it is quiet. The interval
grows to 100 us times the number of servers if it has clients, and to 250 us times that number if it has none;
so long may a client wait to connect. Where somebody tells when a client has sent something (`expect`), the
next round polls, and the interval grows to 1 ms times the number. A turn is due at once after an update,
10 ms after a request, then after 50, 100, 200 ms and so on up to 5 ms times the number of servers (at least
50 ms). Between rounds the pump sleeps, the longer the quieter it is, never more than 3 ms. So a request waits
a few milliseconds, and a run of requests (a file transfer) does not wait at all.
"""

import atexit
import logging
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from types import TracebackType
from typing import Final, Protocol, Self

from mms.server.agenda import Agenda

log: Final = logging.getLogger("mms")

_SHORTEST_PAUSE_S: Final = 0.00005
_LONGEST_PAUSE_S: Final = 0.003
_SHORTEST_POLL_S: Final = 0.001
_POLL_PER_SERVER_S: Final = 0.0001
_POLL_PER_IDLE_SERVER_S: Final = 0.00025
_POLL_PER_EXPECTED_SERVER_S: Final = 0.001
_TURN_DELAY_AFTER_REQUEST_S: Final = 0.01
"""A request makes reports only if it enables a block or asks for a general interrogation."""
_SHORTEST_INTERVAL_S: Final = 0.05
_INTERVAL_PER_SERVER_S: Final = 0.005


class PumpedServer(Protocol):
    """What the pump calls of a server. The server owns the C object and its lock."""

    @property
    def connections(self) -> int:
        """Number of connected clients."""

    def tell_updates(self, updated: Callable[[], None]) -> None:
        """Take what is to be called after each update.

        Parameters
        ----------
        updated : callable
            Called on whichever thread made the update.
        """

    def listen(self) -> None:
        """Open the port.

        Raises
        ------
        ServerStartFailed
            The address and port cannot be had.
        """

    def serve_pending(self) -> bool:
        """Serve what clients have sent.

        Returns
        -------
        bool
            False if nothing had come.
        """

    def take_turn(self) -> bool:
        """Do periodic tasks and send waiting reports.

        Returns
        -------
        bool
            True if that waited a millisecond.
        """

    def close(self) -> None:
        """Free the server."""


@dataclass(slots=True)
class _Polling:
    """How long after its last poll one server is polled next [s]."""

    server: PumpedServer
    interval_s: float = 0.0
    has_no_client: bool = True
    is_told_of: bool = False

    @property
    def longest_s(self) -> float:
        """Longest interval for each server that the pump has [s]."""
        if self.is_told_of:
            return _POLL_PER_EXPECTED_SERVER_S
        return _POLL_PER_IDLE_SERVER_S if self.has_no_client else _POLL_PER_SERVER_S


class ServerPump:
    """One thread that serves any number of servers; a context manager that stops them.

    Parameters
    ----------
    servers : iterable of PumpedServer
        The servers, none of them started.
    """

    def __init__(self, servers: Iterable[PumpedServer]) -> None:
        self._servers = tuple(servers)
        self._polling = [_Polling(server) for server in self._servers]
        self._polls = Agenda(len(self._servers))
        self._turns = Agenda(len(self._servers))
        self._turn_intervals_s = [_SHORTEST_INTERVAL_S] * len(self._servers)
        self._updated: deque[int] = deque()
        """Places of the servers that have been updated; other threads add to it."""
        self._expected: deque[int] = deque()
        """Places of the servers to which something was sent; other threads add to it."""
        self._place_of = {id(server): place for place, server in enumerate(self._servers)}
        self._longest_interval_s = max(_SHORTEST_INTERVAL_S, _INTERVAL_PER_SERVER_S * len(self._servers))
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="mms-pump", daemon=True)
        self._started = False

    def start(self) -> None:
        """Let all servers listen and serve them.

        Raises
        ------
        ServerStartFailed
            A server cannot listen; then none of them does.
        RuntimeError
            The pump has been started before.
        """
        if self._started:
            raise RuntimeError("the pump has been started before")
        try:
            for place, server in enumerate(self._servers):
                server.tell_updates(partial(self._updated.append, place))
                server.listen()
        except BaseException:
            for server in self._servers:
                server.close()
            raise
        self._started = True
        _running.add(self)
        self._thread.start()

    def expect(self, server: PumpedServer) -> None:
        """Poll a server in the next round: something has been sent to it. Any thread may call this.

        Parameters
        ----------
        server : PumpedServer
            One of the pump's; of others it knows nothing.
        """
        place = self._place_of.get(id(server))
        if place is not None:
            self._expected.append(place)

    def stop(self) -> None:
        """Stop serving and free all servers; a second call does nothing. No handler may call this."""
        self._stopping.set()
        if self._started and self._thread.is_alive():
            self._thread.join()
        for server in self._servers:
            server.close()
        _running.discard(self)

    def __enter__(self) -> Self:
        self.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    def _run(self) -> None:
        pause_s = _SHORTEST_PAUSE_S
        while not self._stopping.is_set():
            busy = self._poll()
            if self._give_turns() or busy:
                pause_s = _SHORTEST_PAUSE_S
            else:
                time.sleep(pause_s)
                pause_s = min(2 * pause_s, _LONGEST_PAUSE_S)

    def _poll(self) -> bool:
        """Serve what has come to the servers that are due; return True if anything had."""
        busy = False
        now_s = time.monotonic()
        due: set[int] = set()
        while self._expected:
            place = self._expected.popleft()
            self._polling[place].is_told_of = True
            self._polling[place].interval_s = 0.0  # it may be told a moment before it comes
            due.add(place)
        while (next_place := self._polls.take(now_s)) is not None:
            due.add(next_place)
        for place in due:
            polling = self._polling[place]
            if polling.server.serve_pending():
                busy = True
                polling.interval_s = 0.0
                # Clients come and go only where something came.
                polling.has_no_client = polling.server.connections == 0
                self._hasten_turn(place, now_s + _TURN_DELAY_AFTER_REQUEST_S)
            else:
                longest_s = len(self._servers) * polling.longest_s
                polling.interval_s = min(max(2 * polling.interval_s, _SHORTEST_POLL_S), longest_s)
            self._polls.put(place, now_s + polling.interval_s)
        return busy

    def _hasten_turn(self, place: int, due_s: float) -> None:
        """Let a server's next turn be due at this time at the latest, and the ones after it soon."""
        self._turn_intervals_s[place] = _SHORTEST_INTERVAL_S
        self._turns.hasten(place, due_s)

    def _give_turns(self) -> bool:
        """Give turns to due servers, the longest overdue first, until one has waited.

        It returns True if more are due.
        """
        now_s = time.monotonic()
        while self._updated:
            self._hasten_turn(self._updated.popleft(), now_s)
        while (place := self._turns.take(now_s)) is not None:
            interval_s = self._turn_intervals_s[place]
            waited = self._servers[place].take_turn()
            self._turns.put(place, now_s + interval_s)
            self._turn_intervals_s[place] = min(2 * interval_s, self._longest_interval_s)
            if waited:
                return self._turns.is_due(now_s)
        return False


_running: Final[set[ServerPump]] = set()


@atexit.register
def _stop_all() -> None:
    for pump in list(_running):
        pump.stop()
