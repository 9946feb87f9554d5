"""The GOOSE gateway: what is heard becomes alarms, and requests for recordings."""

import time
from typing import Final
from uuid import uuid4

import structlog
from sqlalchemy.exc import SQLAlchemyError

import scl
from core.time_stamps import rfc3339
from service.alarms.kinds import AlarmKind
from service.configuration.gateways.goose import GooseSettings
from service.configuration.settings import Settings
from service.gateways.context import GatewayContext
from service.gateways.goose.listener import SignalChange
from service.gateways.goose.pending import PendingChanges
from service.gateways.goose.receiver import LOOK_S, Receiver
from service.gateways.goose.signals import Meaning, SignalError, WatchedBlock, watched_blocks
from service.storage import NotFoundError, Repository, StorageError
from service.storage.records import Actor, AlarmPlace, AlarmSpec
from service.timing.database_silence import database_trouble

log = structlog.get_logger(__name__)

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
    changes = PendingChanges(blocks)
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


def _write_changes(context: GatewayContext, receiver: Receiver, changes: PendingChanges) -> None:
    """Write what is heard until the service is gone, whether the interface still works or not.

    Raises what has ended the receiver, once all is written that it had heard.
    """
    writer = SignalWriter(context.repository, context.settings.max_open_requests)
    while not context.stop.is_set():
        error = receiver.error  # looked at first: all that it had heard waits by then
        change = changes.wait_for_next(LOOK_S)
        if change is None and error is not None and changes.is_empty:
            raise error
        key = uuid4().hex
        while change is not None and not context.stop.is_set():
            try:
                writer.write(change, time.time_ns(), key)
                change = None
            except SQLAlchemyError as error:
                context.tell(database_trouble(error))
                context.stop.wait(RETRY_S)
        problems = [problem for problem in (receiver.problem, changes.problem) if problem is not None]
        context.tell("; ".join(problems) or None)


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
