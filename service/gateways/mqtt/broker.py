"""Connections to the broker: encrypted where they leave the machine, opened again for ever."""

import asyncio
import logging
import ssl
import time
from collections.abc import Awaitable, Callable, Coroutine, Iterable
from itertools import islice
from threading import Event
from types import TracebackType
from typing import NamedTuple

from aiomqtt import Client, MqttError, ProtocolVersion, Will
from paho.mqtt.client import Client as PahoClient
from paho.mqtt.packettypes import PacketTypes
from paho.mqtt.properties import Properties
from paho.mqtt.reasoncodes import ReasonCode

from mms import CredentialFileError, read_secret
from service.configuration.gateways.mqtt import MqttSettings

SHORTEST_PAUSE_S, LONGEST_PAUSE_S = 0.5, 10.0
LONG_ENOUGH_S = 30.0
"""A connection that has lasted so long was a good one: the next attempt follows soon."""

LARGEST_PACKET = 64 * 1024
"""Larger ones are not for us. MQTT 5 lets a broker know."""

MOST_WAITING_MESSAGES = 16
AT_ONCE = 20
"""Messages that are on their way together. They arrive in their order."""

log = logging.getLogger("statorwatch.mqtt")
log.setLevel(logging.ERROR)
AT_LEAST_ONCE = 1
LOOK_S = 0.5
"""Between two looks whether a connection is there."""


class Message(NamedTuple):
    """What is published: retained unless it happens once."""

    topic: str
    payload: bytes
    retain: bool = True


class Broker(Client):
    """A connection that takes no refusal for a success, which brokers of MQTT 5 tell."""

    def __init__(self, settings: MqttSettings, will: Will, *, client_id: str) -> None:
        """Raises CredentialFileError, OSError."""
        is_newest = settings.protocol == "5"
        super().__init__(
            settings.host,
            settings.broker_port,
            username=settings.user,
            password=_password(settings),
            logger=log,
            identifier=client_id,
            protocol=ProtocolVersion.V5 if is_newest else ProtocolVersion.V311,
            will=will,
            clean_session=None if is_newest else True,
            timeout=settings.timeout_s,
            keepalive=settings.keepalive_s,
            max_queued_incoming_messages=MOST_WAITING_MESSAGES,
            max_inflight_messages=AT_ONCE,
            properties=_limits() if is_newest else None,
            tls_context=_tls(settings),
        )
        self.pending_calls_threshold = 2 * AT_ONCE
        self._settings = settings
        self._refused: ReasonCode | None = None

    async def publish_all(self, messages: Iterable[Message]) -> None:
        """Publish in this order; return when the broker has all of them. Raises MqttError."""
        waiting = iter(messages)
        while batch := list(islice(waiting, AT_ONCE)):
            sending = [
                self.publish(one.topic, one.payload, qos=AT_LEAST_ONCE, retain=one.retain) for one in batch
            ]
            for outcome in await asyncio.gather(*sending, return_exceptions=True):
                if isinstance(outcome, BaseException):
                    raise outcome
            if self._refused is not None:
                raise MqttError(f"the broker refuses what is published: {self._refused}")

    async def lost(self) -> None:
        """Wait until the connection is lost, then raise MqttError.

        The library forgets it where that happens in the act of opening, so it is looked at.
        """
        while self._client.socket() is not None:
            await asyncio.sleep(LOOK_S)
        raise MqttError("the connection was lost")

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            await super().__aexit__(kind, error, trace)
        finally:
            # Why it was lost is told by then, or of no use: asyncio would complain that nobody read it.
            if self._disconnected.done() and not self._disconnected.cancelled():
                self._disconnected.exception()

    async def leave_with_will(self) -> None:
        """End the connection; the broker tells the will, where it speaks MQTT 5. Raises MqttError."""
        if self._settings.protocol == "5":
            self._client.disconnect(ReasonCode(PacketTypes.DISCONNECT, "Disconnect with will message"))
            await self._wait_for(asyncio.shield(self._disconnected), timeout=None)

    def _on_publish(
        self,
        client: PahoClient,
        userdata: object,
        mid: int,
        reason_code: ReasonCode,
        properties: Properties,
    ) -> None:
        if reason_code.is_failure:
            self._refused = reason_code
        super()._on_publish(client, userdata, mid, reason_code, properties)


async def stay_connected(
    connect: Callable[[], Broker],
    session: Callable[[Broker], Awaitable[None]],
    stop: Event,
    say: Callable[[str | None], None],
) -> None:
    """Open a connection, let a session use it, and begin anew when it is lost, until the gateway ends.

    connect: makes a new one each time.  say: is told why there is none; the session says when all is well.
    """
    pause_s = SHORTEST_PAUSE_S
    while not stop.is_set():
        begun_s = time.monotonic()
        try:
            async with connect() as broker:
                await session(broker)
            pause_s = SHORTEST_PAUSE_S
        except (MqttError, CredentialFileError, OSError) as error:
            say(str(error) or type(error).__name__)
        if stop.is_set():
            return
        if time.monotonic() - begun_s > LONG_ENOUGH_S:
            pause_s = SHORTEST_PAUSE_S
        await asyncio.to_thread(stop.wait, pause_s)
        pause_s = min(2 * pause_s, LONGEST_PAUSE_S)


async def first_of(*parts: Coroutine[object, object, None]) -> None:
    """Run all until one of them ends, or fails: then the others are ended, and its failure is raised."""
    await _run(parts, asyncio.FIRST_COMPLETED)


async def all_of(*parts: Coroutine[object, object, None]) -> None:
    """Run all to their ends, or until one fails: then the others are ended, and its failure is raised."""
    await _run(parts, asyncio.FIRST_EXCEPTION)


async def _run(parts: Iterable[Coroutine[object, object, None]], until: str) -> None:
    tasks = [asyncio.ensure_future(part) for part in parts]
    try:
        done, _ = await asyncio.wait(tasks, return_when=until)
    finally:
        # More than once: wait_for of Python 3.11 forgets a cancellation where what it waits for is done.
        while pending := [task for task in tasks if not task.done()]:
            for task in pending:
                task.cancel()
            await asyncio.wait(pending, timeout=LOOK_S)
        await asyncio.gather(*tasks, return_exceptions=True)
    for task in done:
        task.result()


def _password(settings: MqttSettings) -> str | None:
    if settings.password_file is None:
        return None
    return read_secret(settings.password_file).decode("utf-8", "surrogateescape").rstrip("\r\n")


def _limits() -> Properties:
    properties = Properties(PacketTypes.CONNECT)  # type: ignore[no-untyped-call]
    properties.MaximumPacketSize = LARGEST_PACKET
    return properties


def _tls(settings: MqttSettings) -> ssl.SSLContext | None:
    if not settings.uses_tls:
        return None
    context = ssl.create_default_context(cafile=settings.ca)
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    if settings.certificate is not None and settings.key is not None:
        context.load_cert_chain(settings.certificate, settings.key)
    return context
