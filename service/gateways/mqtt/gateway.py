"""The MQTT gateway: follows the plant's state and tells it to a broker."""

import asyncio
from functools import partial

from service.configuration.gateways.mqtt import MqttSettings
from service.gateways.context import GatewayContext
from service.gateways.kept_file import KeptFileError
from service.gateways.mqtt.broker import stay_connected
from service.gateways.mqtt.plain_topics import PlainTopics
from service.gateways.mqtt.plant_feed import PlantFeed
from service.gateways.mqtt.sparkplug.edge_node import EdgeNode

WATCH_S = 0.5
TOPICS, SPARKPLUG = "topics", "Sparkplug"


def run(context: GatewayContext) -> None:
    """Tell until the service is gone."""
    settings = context.settings.gateways.mqtt
    assert settings is not None  # noqa: S101 - it was started for them
    try:
        asyncio.run(_tell(context, settings))
    except KeptFileError as error:
        context.tell(str(error))
        context.stop.wait()


async def _tell(context: GatewayContext, settings: MqttSettings) -> None:
    feed = PlantFeed()
    problems = Problems(settings)
    say = partial(problems.say, TOPICS)
    plain = PlainTopics(settings, context, feed, say)
    parts = [stay_connected(plain.connection, plain.session, context.stop, say)]
    if settings.sparkplug is not None:
        say = partial(problems.say, SPARKPLUG)
        node = EdgeNode(settings, settings.sparkplug, context, feed, say)
        parts.append(stay_connected(node.connection, node.session, context.stop, say))
    await asyncio.gather(feed.follow(context), _watch(context, feed, problems), *parts)


async def _watch(context: GatewayContext, feed: PlantFeed, problems: "Problems") -> None:
    """Tell the service what does not work."""
    while not context.stop.is_set():
        told = "; ".join(filter(None, [feed.problem, problems.text()]))
        if told or (feed.is_read.is_set() and problems.is_told):
            context.tell(told or None)
        await asyncio.sleep(WATCH_S)


class Problems:
    """What does not work in each of the connections to the broker."""

    def __init__(self, settings: MqttSettings) -> None:
        self._broker = f"{settings.host}:{settings.broker_port}"
        self._parts = {TOPICS} if settings.sparkplug is None else {TOPICS, SPARKPLUG}
        self._of_part: dict[str, str | None] = {}

    @property
    def is_told(self) -> bool:
        """Tell whether every part has said how it is."""
        return self._of_part.keys() == self._parts

    def say(self, part: str, problem: str | None) -> None:
        """Keep what does not work in a part; None where all does."""
        self._of_part[part] = problem

    def text(self) -> str | None:
        """Return all of it in a line."""
        told = sorted({problem for problem in self._of_part.values() if problem is not None})
        return f"{self._broker}: {', '.join(told)}" if told else None
