"""Watching for simulators that hang: a relay that takes connections and answers nothing."""

import socket
import time
from collections.abc import Callable, Sequence
from threading import Event, Thread
from types import TracebackType
from typing import Self

from scl import Address
from tests.chaos.simulators import SimulatorProcess

PERIOD_S = 5.0
ANSWER_LIMIT_S = 5.0
HANG_LIMIT_S = 45.0
"""Without any answer of a relay; longer than a relay is off or frozen by a fault."""

CONNECT_REQUEST = bytes.fromhex("0300001611e00000000100c1020001c2020001c0010a")
"""Connect request of the ISO transport over TCP (RFC 1006, ISO 8073)."""


class HangWatch:
    """Asks every relay now and then, in a thread of its own while the context is entered.

    A simulator of which a relay has not answered for `limit_s` is ended with its stacks and started anew, so
    that the run can go on. `note` gets a line of it.
    """

    def __init__(
        self,
        simulators: Sequence[SimulatorProcess],
        note: Callable[[str], None],
        *,
        period_s: float = PERIOD_S,
        answer_limit_s: float = ANSWER_LIMIT_S,
        limit_s: float = HANG_LIMIT_S,
    ) -> None:
        self._simulators = simulators
        self._note = note
        self._period_s = period_s
        self._answer_limit_s = answer_limit_s
        self._limit_s = limit_s
        self._answered_s: dict[str, float] = {}
        self._stopping = Event()
        self._thread = Thread(target=self._watch, name="hang-watch")

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()

    def stop(self) -> None:
        """Watch no longer; a second call does nothing."""
        self._stopping.set()
        self._thread.join()

    def _watch(self) -> None:
        while not self._stopping.wait(self._period_s):
            for simulator in self._simulators:
                self._look_at(simulator)

    def _look_at(self, simulator: SimulatorProcess) -> None:
        for relay, address in simulator.relays.items():
            if self._stopping.is_set():
                return
            if _answers(address, self._answer_limit_s):
                self._answered_s[relay] = time.monotonic()
            since_s = simulator.serves_since_s
            if since_s is None:  # off, as a fault wants it
                return
            silent_s = time.monotonic() - max(since_s, self._answered_s.get(relay, 0.0))
            if silent_s > self._limit_s:
                what = f"hangs: {relay} has not answered for {silent_s:.0f} s"
                self._note(f"a simulator {what}")
                simulator.restart_hung(what)
                return


def _answers(address: Address, limit_s: float) -> bool:
    """Tell whether anything comes back to a connect request, be it the end of the connection."""
    try:
        with socket.create_connection((address.host, address.port), timeout=limit_s) as connection:
            connection.sendall(CONNECT_REQUEST)
            connection.recv(1)
    except ConnectionResetError:
        return True
    except OSError:  # refused, or too late
        return False
    return True
