"""The GOOSE gateway: a socket is read on a thread of its own, so that no message waits for the database."""

import time
from collections.abc import Sequence
from contextlib import suppress
from threading import Condition, Event, Thread
from typing import Final
from uuid import uuid4

import structlog
from sqlalchemy.exc import SQLAlchemyError

import scl
from core.time_stamps import rfc3339
from mms.goose import RawSocket, RawSocketError
from service.alarms.kinds import AlarmKind
from service.configuration.gateways.goose import GooseSettings
from service.configuration.settings import Settings
from service.gateways.context import GatewayContext
from service.gateways.goose.listener import GooseListener, SignalChange
from service.gateways.goose.signals import (
    Meaning,
    Signal,
    SignalError,
    WatchedBlock,
    destinations,
    watched_blocks,
)
from service.storage import NotFoundError, Repository, StorageError
from service.storage.records import Actor, AlarmPlace, AlarmSpec
from service.timing.database_silence import database_trouble

log = structlog.get_logger(__name__)

LOOK_S: Final = 0.5
"""Longest wait for a frame or a change before it is seen whether the service is gone."""
REOPEN_S: Final = 5.0
"""Between attempts to have the socket."""
RETRY_S: Final = 1.0
"""Between attempts while the database does not answer."""
GOOSE: Final = Actor("goose", "service")
"""Who asked for a recording, in the audit trail."""


def run(context: GatewayContext) -> None:
    """Listen until the service is gone."""
    chosen = context.settings.gateways.goose
    assert chosen is not None  # noqa: S101 - it was started for them
    blocks = _watched_blocks(context, chosen)
    if not blocks:
        return
    changes = PendingChanges()
    receiver = Receiver(chosen, blocks, changes, context.stop)
    receiver.start()
    try:
        _write_changes(context, receiver, changes)
    finally:
        receiver.stop()


def _watched_blocks(context: GatewayContext, chosen: GooseSettings) -> tuple[WatchedBlock, ...]:
    """Return what is to be heard; nothing where the service is gone before that is known."""
    while not context.stop.is_set():
        try:
            # The service has written the plant before its gateways start.
            relays = context.repository.relays_of_motors()
            return watched_blocks(chosen, _document(context.settings), relays)
        except SQLAlchemyError as error:
            context.tell(database_trouble(error))
            context.stop.wait(RETRY_S)
        except (SignalError, scl.SclError) as error:
            log.warning("the GOOSE gateway cannot listen", error=str(error))
            context.tell(str(error))
            context.stop.wait()  # Starting it again would change nothing.
    return ()


def _document(settings: Settings) -> scl.Scl:
    """Read the SCD. Raises SignalError, SclError."""
    if settings.scd is None:
        raise SignalError("gateways.goose: expected the setting scd, whose GSEControl says what is sent")
    return scl.read(settings.scd)


def _write_changes(context: GatewayContext, receiver: "Receiver", changes: "PendingChanges") -> None:
    """Write what is heard until the service is gone, whether the interface still works or not."""
    writer = SignalWriter(context.repository, context.settings.max_open_requests)
    while not context.stop.is_set():
        change = changes.wait_for_next(LOOK_S)
        key = uuid4().hex
        while change is not None and not context.stop.is_set():
            try:
                writer.write(change, time.time_ns(), key)
                change = None
            except SQLAlchemyError as error:
                context.tell(database_trouble(error))
                context.stop.wait(RETRY_S)
        context.tell(receiver.problem)


class Receiver:
    """Reads a socket on a thread of its own, and opens it again where the interface fails."""

    def __init__(
        self, chosen: GooseSettings, blocks: Sequence[WatchedBlock], changes: "PendingChanges", stop: Event
    ) -> None:
        self._interface = chosen.interface
        self._groups = destinations(blocks)
        self._listener = GooseListener(blocks, simulated=chosen.simulated)
        self._changes = changes
        self._stop = stop
        self.problem: str | None = self._listener.problem
        """What does not work; None where all does."""
        self._thread = Thread(target=self._run, name="GOOSE receiver", daemon=True)

    def start(self) -> None:
        """Begin to read."""
        self._thread.start()

    def stop(self) -> None:
        """Wait for the thread, which ends by the event."""
        self._thread.join()

    def _run(self) -> None:
        while not self._stop.is_set():
            try:
                with RawSocket(self._interface, self._groups) as socket:
                    socket.wait_at_most(LOOK_S)
                    self._read(socket)
            except RawSocketError as error:  # An interface may come up later.
                self._fail(str(error))
            except OSError as error:  # It is down or gone: a new socket is had once it is back.
                self._fail(f"{self._interface}: {error}")

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


class PendingChanges:
    """Changes of signals that wait for the database.

    The latest rise and the latest fall of each signal are kept, in their order. So nothing grows while the
    database is silent, no trip is lost, and the last state is that of the relay. A signal that rises several
    times meanwhile asks for one record.
    """

    def __init__(self) -> None:
        self._changed = Condition()
        self._changes: dict[tuple[Signal, bool], SignalChange] = {}

    def add(self, change: SignalChange) -> None:
        """Put a change behind the others."""
        key = change.signal, change.is_on
        with self._changed:
            self._changes.pop(key, None)
            self._changes[key] = change
            self._changed.notify()

    def wait_for_next(self, longest_s: float) -> SignalChange | None:
        """Take the next change; None where there was none for so long."""
        with self._changed:
            if not self._changes:
                self._changed.wait(longest_s)
            key = next(iter(self._changes), None)
            return None if key is None else self._changes.pop(key)


class SignalWriter:
    """Does what the signals mean: alarms of trips, and requests for recordings."""

    def __init__(self, repository: Repository, most_open: int) -> None:
        self._repository = repository
        self._most_open = most_open

    def write(self, change: SignalChange, now_ns: int, key: str) -> None:
        """Write what a change means. Raises SQLAlchemyError where the database does not answer.

        key: of this change. Written again with it, nothing is asked for twice.
        """
        log.info("a GOOSE signal", signal=change.signal.reference, is_on=change.is_on)
        for motor in change.signal.motors:
            try:
                if change.signal.meaning is Meaning.TRIP:
                    self._tell_trip(motor, change, now_ns)
                elif change.is_on:
                    self._repository.request_recording(
                        motor, by=GOOSE, now_ns=now_ns, idempotency_key=key, most_open=self._most_open
                    )
            except NotFoundError as error:
                log.warning("a GOOSE signal has no motor", error=str(error))
            except StorageError as error:
                log.warning("a GOOSE signal asks for what is refused", error=str(error))

    def _tell_trip(self, motor: str, change: SignalChange, now_ns: int) -> None:
        place, subject = AlarmPlace(motor=motor), change.signal.reference
        if not change.is_on:
            self._repository.clear_alarms_at(
                place,
                AlarmKind.MOTOR_TRIPPED,
                now_ns=now_ns,
                subject=subject,
                why="the relay's trip has fallen",
            )
            return
        told = rfc3339(change.time_ns)[:23]
        reason = f"{subject} is on since {told}Z by the relay's clock"
        self._repository.raise_alarm_at(
            place, AlarmSpec(AlarmKind.MOTOR_TRIPPED, reason, subject), now_ns=now_ns
        )
