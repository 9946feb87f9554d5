"""A socket that hears GOOSE, read on a thread of its own: no message waits for the database."""

import time
from collections.abc import Sequence
from contextlib import suppress
from threading import Event, Thread
from typing import Final

import structlog

from mms.goose import RawSocket, RawSocketError
from service.configuration.gateways.goose import GooseSettings
from service.gateways.goose.listener import GooseListener
from service.gateways.goose.pending import PendingChanges
from service.gateways.goose.signals import WatchedBlock, destinations

log = structlog.get_logger(__name__)

LOOK_S: Final = 0.5
"""Longest wait for a frame or a change before it is seen whether the service is gone."""
REOPEN_S: Final = 5.0
"""Between attempts to have the socket."""


class Receiver:
    """Reads a socket on a thread of its own, and opens it again where the interface fails."""

    def __init__(
        self, chosen: GooseSettings, blocks: Sequence[WatchedBlock], changes: PendingChanges, stop: Event
    ) -> None:
        self._interface = chosen.interface
        self._groups = destinations(blocks)
        self._listener = GooseListener(blocks, simulated=chosen.simulated)
        self._changes = changes
        self._stop = stop
        self.problem: str | None = self._listener.problem
        """What does not work; None where all does."""
        self.error: Exception | None = None
        """What has ended the thread; None while it listens."""
        self._thread = Thread(target=self._run, name="GOOSE receiver", daemon=True)

    def start(self) -> None:
        """Begin to read."""
        self._thread.start()

    def stop(self) -> None:
        """Wait for the thread, which ends by the event."""
        self._thread.join()

    def _run(self) -> None:
        try:
            self._hear()
        except Exception as error:  # its owner raises it: the gateway ends, and is started again
            log.exception("the GOOSE receiver failed")
            self.problem = f"the GOOSE receiver failed: {error!r}"
            self.error = error

    def _hear(self) -> None:
        while not self._stop.is_set():
            try:
                with RawSocket(self._interface, self._groups) as socket:
                    socket.wait_at_most(LOOK_S)
                    self._read(socket)
            except RawSocketError as error:  # An interface may come up later.
                self._fail(str(error))
            except OSError as error:  # It is down or gone: a new socket is had once it is back.
                self._fail(f"{self._interface}: {error.strerror}")

    def _fail(self, problem: str) -> None:
        if self.problem != problem:
            log.warning("the GOOSE gateway hears nothing", reason=problem)
            self.problem = problem
        self._stop.wait(REOPEN_S)

    def _read(self, socket: RawSocket) -> None:
        looked_s = 0.0
        while not self._stop.is_set():
            octets = None
            with suppress(TimeoutError):
                octets = socket.receive()
            now_s = time.monotonic()
            for change in self._listener.receive(octets, now_s) if octets else ():
                self._changes.add(change)
            if now_s - looked_s >= LOOK_S:
                looked_s = now_s
                self._listener.expire(now_s)
                self.problem = self._listener.problem
