"""The state of motors, relays and alarms as JSON that the broker keeps, and what happened, once each."""

import asyncio
import time
from collections.abc import Callable, Iterator

from aiomqtt import Will
from sqlalchemy.exc import SQLAlchemyError

from service.configuration.gateways.mqtt import MqttSettings
from service.gateways.context import GatewayContext
from service.gateways.mqtt import documents
from service.gateways.mqtt.broker import AT_LEAST_ONCE, Broker, Message, all_of, first_of
from service.gateways.mqtt.history import History, Telling
from service.gateways.mqtt.kept_topics import KeptTopics
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
        self._topics = KeptTopics(context.settings.data_directory)
        self._status = f"{settings.prefix}/status"

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
        # A database that does not answer is told as well: the state does not wait for the history.
        await all_of(self._tell_states(broker), self._tell_history(broker))
        await broker.publish_all([Message(self._status, documents.offline())])

    async def _tell_states(self, broker: Broker) -> None:
        told = self._feed.begin()
        while not self._stop.is_set():
            change = await self._feed.next_change(told)
            if change is not None:
                await self._tell_state(broker, change)
                told = change.now

    async def _tell_state(self, broker: Broker, change: PlantChange) -> None:
        topics = {
            self._topic(one)
            for some in (change.now.motors, change.now.relays, change.now.alarms)
            for one in some.values()
        }
        # First noted, then kept by the broker: whatever happens, it can be taken away again.
        await asyncio.to_thread(self._topics.add, topics)
        await broker.publish_all(
            Message(self._topic(one), documents.figures(one)) for one in _changed(change)
        )
        gone = self._topics.gone(topics)
        await broker.publish_all(Message(topic, b"") for topic in gone)
        await asyncio.to_thread(self._topics.forget, gone)
        is_first = change.before.read_ns == 0
        if is_first or change.before.is_current != change.now.is_current:
            await broker.publish_all(
                [Message(self._status, documents.online(is_current=change.now.is_current))]
            )

    async def _tell_history(self, broker: Broker) -> None:
        """Tell what happened; it counts as told when the broker has it."""
        seen, read_s = None, 0.0
        while not self._stop.is_set():
            latest = self._feed.latest
            is_due = latest is not seen or time.monotonic() - read_s > CONDITIONS_S
            try:
                await self._tell_alarms(broker)
                if is_due:
                    for telling in await asyncio.to_thread(self._conditions):
                        await self._tell_changes(broker, telling)
                    seen, read_s = latest, time.monotonic()
            except SQLAlchemyError as error:
                self._say(database_trouble(error))
            else:
                self._say(None)
            await self._feed.next_change(latest)

    async def _tell_alarms(self, broker: Broker) -> None:
        if self._position.is_new:
            await asyncio.to_thread(self._history.begin, self._position)
        while (telling := await asyncio.to_thread(self._history.alarms, self._position)) is not None:
            await self._tell_changes(broker, telling)

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
