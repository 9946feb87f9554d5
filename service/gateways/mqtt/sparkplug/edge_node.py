"""The edge node: born with all its motors, told to be born again, and dead when its connection is lost."""

import asyncio
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

import structlog
from aiomqtt import MqttError, Will

from core.units import NANOSECONDS_PER_MILLISECOND
from service.configuration.gateways.mqtt import MqttSettings, SparkplugSettings
from service.gateways.context import GatewayContext
from service.gateways.kept_file import KeptFileError, read_kept, write_kept
from service.gateways.mqtt.broker import AT_LEAST_ONCE, LOOK_S, Broker, first_of
from service.gateways.mqtt.documents import VERSION
from service.gateways.mqtt.plant_feed import PlantFeed
from service.gateways.mqtt.sparkplug.metrics import changed, of_motor
from service.gateways.mqtt.sparkplug.payload import DataType, Metric, PayloadError, encode, is_ordered
from service.gateways.mqtt.sparkplug.primary_host import PrimaryHost
from service.gateways.mqtt.topics import level
from service.gateways.plant_state.figures import PlantChange, PlantState

log = structlog.get_logger(__name__)

NAMESPACE = "spBv1.0"
REBIRTH = "Node Control/Rebirth"
BIRTH_PAUSE_S = 5.0
"""After a birth the next one that is ordered waits so long: who orders many gets few."""

BIRTHS = "mqtt-sparkplug.json"
NUMBERS = 256


class BirthNumber:
    """bdSeq: which birth a death belongs to. It goes on across restarts of the gateway."""

    def __init__(self, data_directory: Path) -> None:
        """Raises KeptFileError."""
        self._file = data_directory / BIRTHS
        found = read_kept(self._file)
        number = -1 if found is None else found.get("bdSeq")
        if not isinstance(number, int) or isinstance(number, bool) or not -1 <= number < NUMBERS:
            raise KeptFileError(f"{self._file}: expected bdSeq from 0 to 255, found another document")
        self._number = number

    def next(self) -> int:
        """Return the number of the next connection; it is kept before it is used. Raises OSError."""
        number = (self._number + 1) % NUMBERS
        write_kept(self._file, {"bdSeq": number})
        self._number = number
        return number


class EdgeNode:
    """What one connection is for; it may be opened many times."""

    def __init__(
        self,
        settings: MqttSettings,
        names: SparkplugSettings,
        context: GatewayContext,
        feed: PlantFeed,
        say: Callable[[str | None], None],
    ) -> None:
        """Raises KeptFileError."""
        self._settings = settings
        self._names = names
        self._stop = context.stop
        self._feed = feed
        self._say = say
        self._host = None if names.primary_host is None else PrimaryHost(names.primary_host, NAMESPACE)
        self._births = BirthNumber(context.settings.data_directory)
        self._birth = 0
        self._sequence = 0
        self._told = PlantState()
        self._is_born = False
        self._publishing = asyncio.Lock()
        self._ordered = asyncio.Event()

    def connection(self) -> Broker:
        """Return a new connection, with its death in the broker's hands.

        Raises CredentialFileError, OSError.
        """
        self._birth = self._births.next()
        will = Will(self._topic("NDEATH"), self._death(), qos=AT_LEAST_ONCE, retain=False)
        return Broker(self._settings, will, client_id=f"{self._settings.client_id}-sparkplug")

    async def session(self, broker: Broker) -> None:
        """Be born, tell changes, and hear commands.

        It ends when the gateway is to end, the primary host goes offline, or the connection is lost.
        """
        self._told, self._is_born = self._feed.begin(), False
        self._ordered.clear()
        await self._subscribe(broker, self._topic("NCMD"), "its commands")
        if self._host is None:
            self._say(None)
        else:
            self._host.forget()
            self._say(self._host.awaited)
            await self._subscribe(broker, self._host.topic, "the state of its primary host")
        await first_of(broker.lost(), self._hear(broker), self._bear_again(broker), self._tell(broker))
        if self._host is not None and not self._stop.is_set():
            self._say(self._host.awaited)
        if self._is_born:
            await broker.publish(self._topic("NDEATH"), self._death(), qos=AT_LEAST_ONCE)
        await broker.leave_with_will()

    async def _subscribe(self, broker: Broker, topic: str, what: str) -> None:
        granted = await broker.subscribe(topic, qos=AT_LEAST_ONCE)
        if any((one if isinstance(one, int) else one.value) >= 0x80 for one in granted):
            raise MqttError(f"the broker refuses the edge node's subscription to {what}")

    async def _tell(self, broker: Broker) -> None:
        await self._host_is_online()
        while not self._stop.is_set():
            change = await self._feed.next_change(self._told)
            if change is None:
                continue
            async with self._publishing:
                self._told = change.now
                if self._is_born:
                    await self._tell_change(broker, change)
                else:
                    await self._bear(broker)

    async def _host_is_online(self) -> None:
        """Wait for the primary host, where there is one; no longer than the gateway runs."""
        if self._host is None:
            return
        while not self._stop.is_set():
            with suppress(TimeoutError):
                async with asyncio.timeout(LOOK_S):
                    await self._host.is_online.wait()
                self._say(None)
                return

    async def _bear(self, broker: Broker) -> None:
        """Tell everything, from sequence number 0 on."""
        self._sequence, self._is_born = 0, True
        now_ms = _now_ms()
        node = (
            self._birth_number(now_ms),
            Metric(REBIRTH, DataType.BOOLEAN, value=False, timestamp_ms=now_ms),
            Metric("Properties/Software", DataType.STRING, "StatorWatch", now_ms),
            Metric("Properties/Version", DataType.STRING, VERSION, now_ms),
            _database(self._told, now_ms),
        )
        await self._publish(broker, "NBIRTH", node)
        for motor in self._told.motors.values():
            await self._publish(broker, "DBIRTH", of_motor(motor, self._told), motor.name)

    async def _tell_change(self, broker: Broker, change: PlantChange) -> None:
        if change.before.is_current != change.now.is_current:
            await self._publish(broker, "NDATA", (_database(change.now, _now_ms()),))
        for name in change.motors_gone:
            await self._publish(broker, "DDEATH", (), name)
        relays = {relay.name for relay in change.relays}
        touched = {motor.name for motor in change.motors}
        for motor in change.now.motors.values():
            if motor.name not in touched and motor.relay not in relays:
                continue
            now = of_motor(motor, change.now)
            before = change.before.motors.get(motor.name)
            if before is None:
                await self._publish(broker, "DBIRTH", now, motor.name)
            elif different := changed(of_motor(before, change.before), now):
                await self._publish(broker, "DDATA", different, motor.name)

    async def _hear(self, broker: Broker) -> None:
        """Hear commands, and the primary host's state until it goes offline again.

        What is no command, or is garbled, is left alone.
        """
        async for message in broker.messages:
            if self._host is not None and message.topic.value == self._host.topic:
                was_online = self._host.is_online.is_set()
                self._host.hear(message.payload)
                if was_online and not self._host.is_online.is_set():
                    return
                continue
            try:
                if is_ordered(message.payload, REBIRTH):
                    self._ordered.set()
            except PayloadError as error:
                log.warning("a command of Sparkplug cannot be read", error=str(error))

    async def _bear_again(self, broker: Broker) -> None:
        while True:
            await self._ordered.wait()
            self._ordered.clear()
            async with self._publishing:
                if self._is_born:
                    await self._bear(broker)
            await asyncio.sleep(BIRTH_PAUSE_S)

    async def _publish(self, broker: Broker, kind: str, metrics: Sequence[Metric], device: str = "") -> None:
        payload = encode(metrics, timestamp_ms=_now_ms(), sequence=self._sequence)
        self._sequence = (self._sequence + 1) % NUMBERS
        await broker.publish(self._topic(kind, device), payload)

    def _topic(self, kind: str, device: str = "") -> str:
        of_node = f"{NAMESPACE}/{self._names.group}/{kind}/{self._names.edge_node}"
        return f"{of_node}/{level(device)}" if device else of_node

    def _birth_number(self, now_ms: int) -> Metric:
        return Metric("bdSeq", DataType.INT64, self._birth, now_ms)

    def _death(self) -> bytes:
        now_ms = _now_ms()
        return encode((self._birth_number(now_ms),), timestamp_ms=now_ms, sequence=None)


def _database(state: PlantState, now_ms: int) -> Metric:
    return Metric("Database/Answers", DataType.BOOLEAN, state.is_current, now_ms)


def _now_ms() -> int:
    return time.time_ns() // NANOSECONDS_PER_MILLISECOND
