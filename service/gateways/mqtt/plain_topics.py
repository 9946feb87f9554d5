"""The state of motors, relays and alarms as JSON that the broker keeps, and what happened, once each."""

import asyncio
import time
from collections.abc import Callable, Iterator

from aiomqtt import Will
from sqlalchemy.exc import SQLAlchemyError

from service.configuration.gateways.mqtt import MqttSettings
from service.gateways.context import GatewayContext
from service.gateways.mqtt import documents
from service.gateways.mqtt.broker import AT_LEAST_ONCE, Broker, Message, first_of
from service.gateways.mqtt.history import History, Telling
from service.gateways.mqtt.plant_feed import PlantFeed
from service.gateways.mqtt.position import Position
from service.gateways.mqtt.topics import level
from service.gateways.plant_state.figures import MotorFigures, PlantChange, RelayFigures
from service.storage.records import Alarm
from service.timing.database_silence import database_trouble

CONDITIONS_S = 30.0
"""The history of conditions is read after each change, and so often."""


class PlainTopics:
    """What one connection is for; it may be opened many times."""

    def __init__(
        self,
        settings: MqttSettings,
        context: GatewayContext,
        feed: PlantFeed,
        say: Callable[[str | None], None],
    ) -> None:
        """Raises KeptFileError."""
        self._settings = settings
        self._feed = feed
        self._say = say
        self._stop = context.stop
        self._history = History(context.repository, settings.prefix)
        self._position = Position(context.settings.data_directory)
        self._status = f"{settings.prefix}/status"
        self._conditions_read_s = 0.0

    def connection(self) -> Broker:
        """Return a new connection; the broker tells when it is lost. Raises CredentialFileError, OSError."""
        will = Will(self._status, documents.offline(), qos=AT_LEAST_ONCE, retain=True)
        return Broker(self._settings, will, client_id=self._settings.client_id)

    async def session(self, broker: Broker) -> None:
        """Tell all there is to tell until the gateway is to end, or the connection is lost."""
        await first_of(broker.lost(), self._tell(broker))

    async def _tell(self, broker: Broker) -> None:
        # Until the database has told the plant, what the broker keeps is old.
        await broker.publish_all([Message(self._status, documents.offline())])
        self._say(None)
        told, self._conditions_read_s = self._feed.begin(), 0.0
        while not self._stop.is_set():
            change = await self._feed.next_change(told)
            if change is not None and await self._has_begun():
                await self._tell_state(broker, change, is_first=told.read_ns == 0)
                told, self._conditions_read_s = change.now, 0.0
            await self._tell_history(broker)
        await broker.publish_all([Message(self._status, documents.offline())])

    async def _tell_state(self, broker: Broker, change: PlantChange, *, is_first: bool) -> None:
        changed = {self._topic(one): documents.figures(one) for one in _changed(change)}
        topics = {
            self._topic(one)
            for some in (change.now.motors, change.now.relays, change.now.alarms)
            for one in some.values()
        }
        gone = self._position.topics - topics
        if topics - self._position.topics:
            # First noted, then kept by the broker: whatever happens, it can be taken away again.
            self._position.topics |= topics
            await asyncio.to_thread(self._position.save)
        await broker.publish_all(Message(topic, payload) for topic, payload in changed.items())
        await broker.publish_all(Message(topic, b"") for topic in sorted(gone))
        if gone:
            self._position.topics -= gone
            await asyncio.to_thread(self._position.save)
        if is_first or change.before.is_current != change.now.is_current:
            await broker.publish_all(
                [Message(self._status, documents.online(is_current=change.now.is_current))]
            )

    async def _has_begun(self) -> bool:
        """Tell whether it is known from where on what happens is to be told."""
        try:
            if self._position.is_new:
                await asyncio.to_thread(self._history.begin, self._position)
        except SQLAlchemyError as error:
            self._say(database_trouble(error))
        return not self._position.is_new

    async def _tell_history(self, broker: Broker) -> None:
        """Tell what happened; it counts as told when the broker has it."""
        if self._position.is_new:
            return
        try:
            while (telling := await asyncio.to_thread(self._history.alarms, self._position)) is not None:
                await self._tell_changes(broker, telling)
            if time.monotonic() - self._conditions_read_s > CONDITIONS_S or self._conditions_read_s == 0:
                for telling in await asyncio.to_thread(self._conditions):
                    await self._tell_changes(broker, telling)
                self._conditions_read_s = time.monotonic()
        except SQLAlchemyError as error:
            self._say(database_trouble(error))
        else:
            self._say(None)

    def _conditions(self) -> list[Telling]:
        return list(self._history.conditions(self._position))

    async def _tell_changes(self, broker: Broker, telling: Telling) -> None:
        await broker.publish_all(telling.messages)
        telling.note(self._position)
        await asyncio.to_thread(self._position.save)

    def _topic(self, one: MotorFigures | RelayFigures | Alarm) -> str:
        match one:
            case MotorFigures():
                place = f"motors/{level(one.site)}/{level(one.name)}"
            case RelayFigures():
                place = f"relays/{level(one.site)}/{level(one.name)}"
            case _:
                place = f"alarms/{level(one.id)}"
        return f"{self._settings.prefix}/{place}/state"


def _changed(change: PlantChange) -> Iterator[MotorFigures | RelayFigures | Alarm]:
    yield from change.motors
    yield from change.relays
    yield from change.alarms
