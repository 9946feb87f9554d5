"""Driving many servers from one thread.

libiec61850's own threads cost about 0.6 % of a core a server; one thread over all of them far less.
Each round the pump looks at servers for data and serves it, then gives one server a turn, in which that
server sends its reports. A server is looked at in every round after a request, then the more rarely the
longer it is quiet: with clients up to 60 us times the number of servers, without any up to 250 us times that
number, which is how long a client may wait to connect. It is due for a turn at once after an update, 10 ms
after a request, then after 50, 100, 200 ms and so on up to 5 ms times the number of servers (at least 50 ms).
Between rounds the pump sleeps, the longer the quieter it is, never more than 3 ms. So a request waits a few
milliseconds, a run of requests (a file transfer) not at all.
"""

import atexit
import logging
import threading
import time
from collections.abc import Iterable
from dataclasses import dataclass
from types import TracebackType
from typing import Final, Protocol, Self

log: Final = logging.getLogger("mms")

_SHORTEST_PAUSE_S: Final = 0.00005
_LONGEST_PAUSE_S: Final = 0.003
_SHORTEST_LOOKS_S: Final = 0.001
_LOOKS_PER_SERVER_S: Final = 0.00006
_LOOKS_PER_LONELY_SERVER_S: Final = 0.00025
_SHORTEST_INTERVAL_S: Final = 0.05
_INTERVAL_PER_SERVER_S: Final = 0.005


class PumpedServer(Protocol):
    """What the pump calls of a server; the server owns the C object and its lock."""

    @property
    def connections(self) -> int: ...

    @property
    def turn_delay_s(self) -> float: ...

    def listen(self) -> None: ...

    def serve_pending(self) -> bool: ...

    def take_turn(self) -> bool: ...

    def close(self) -> None: ...


@dataclass(slots=True)
class _Looks:
    """When one server is looked at next [s, monotonic], and how long after the last look that is [s]."""

    server: PumpedServer
    due_s: float = 0.0
    interval_s: float = 0.0
    lonely: bool = True


@dataclass(slots=True)
class _Turns:
    """When one server's next turn is due [s, monotonic], and the interval that then follows [s]."""

    server: PumpedServer
    due_s: float = 0.0
    interval_s: float = _SHORTEST_INTERVAL_S


class ServerPump:
    """One thread that serves any number of servers; a context manager, which stops them."""

    def __init__(self, servers: Iterable[PumpedServer]) -> None:
        self._servers = tuple(servers)
        self._looks = [_Looks(server) for server in self._servers]
        self._turns = [_Turns(server) for server in self._servers]
        self._longest_interval_s = max(_SHORTEST_INTERVAL_S, _INTERVAL_PER_SERVER_S * len(self._servers))
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="mms-pump", daemon=True)
        self._started = False

    def start(self) -> None:
        """Let all servers listen and serve them; if one cannot, none does (ServerStartFailed)."""
        if self._started:
            raise RuntimeError("the pump has been started before")
        try:
            for server in self._servers:
                server.listen()
        except BaseException:
            for server in self._servers:
                server.close()
            raise
        self._started = True
        _running.add(self)
        self._thread.start()

    def stop(self) -> None:
        """Stop serving and free all servers; harmless when stopped. Not from a handler."""
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
            busy = self._look()
            if self._give_turns() or busy:
                pause_s = _SHORTEST_PAUSE_S
            else:
                time.sleep(pause_s)
                pause_s = min(2 * pause_s, _LONGEST_PAUSE_S)

    def _look(self) -> bool:
        """Serve what has come to the servers that are to be looked at; True if anything had."""
        busy = False
        now_s = time.monotonic()
        for looks in self._looks:
            if looks.due_s > now_s:
                continue
            if looks.server.serve_pending():
                busy = True
                looks.due_s = looks.interval_s = 0.0
                looks.lonely = looks.server.connections == 0  # clients come and go only where something came
            else:
                each_s = _LOOKS_PER_LONELY_SERVER_S if looks.lonely else _LOOKS_PER_SERVER_S
                longest_s = len(self._looks) * each_s
                looks.interval_s = min(max(2 * looks.interval_s, _SHORTEST_LOOKS_S), longest_s)
                looks.due_s = now_s + looks.interval_s
        return busy

    def _give_turns(self) -> bool:
        """Turns to due servers, the longest overdue first, until one has waited; True if more are due."""
        now_s = time.monotonic()
        due = []
        for turns in self._turns:
            turn_delay_s = turns.server.turn_delay_s
            if turn_delay_s < _SHORTEST_INTERVAL_S:
                turns.due_s = min(turns.due_s, now_s + turn_delay_s)
                turns.interval_s = _SHORTEST_INTERVAL_S
            if turns.due_s <= now_s:
                due.append(turns)
        due.sort(key=lambda turns: turns.due_s)
        for place, turns in enumerate(due, 1):
            waited = turns.server.take_turn()
            turns.due_s = now_s + turns.interval_s
            turns.interval_s = min(2 * turns.interval_s, self._longest_interval_s)
            if waited:
                return place < len(due)
        return False


_running: Final[set[ServerPump]] = set()


@atexit.register
def _stop_all() -> None:
    for pump in list(_running):
        pump.stop()
