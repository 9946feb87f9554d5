"""Both kinds of topics tell that the database does not answer: no value counts as good any more."""

import asyncio
import json
import time
from pathlib import Path
from threading import Event

from service.gateways.context import GatewayContext
from service.gateways.mqtt.broker import stay_connected
from service.gateways.mqtt.plain_topics import PlainTopics
from service.gateways.mqtt.plant_feed import PlantFeed
from service.gateways.mqtt.sparkplug.edge_node import EdgeNode
from service.gateways.plant_state.reading import read_plant_state
from service.storage import Repository
from testing.service import sparkplug
from testing.service.conditions import HEALTHY, tell
from testing.service.mosquitto import Heard, Mosquitto
from testing.waiting import eventually
from tests.service.gateways.mqtt.conftest import settings_of

PUMP = "statorwatch/motors/FACTORY_A/PUMP-A1/state"


def test_nothing_is_good_any_more(repository: Repository, broker: Mosquitto, tmp_path: Path) -> None:
    tell(repository, HEALTHY)
    with broker.listening("#") as heard:
        asyncio.run(_tell(repository, broker, tmp_path, heard))
    data = [one for one in sparkplug.told(_of(heard, "spBv1.0/")) if one.kind in ("NDATA", "DDATA")]
    assert [(one.kind, one.sequence) for one in data] == [("NDATA", 3), ("DDATA", 4), ("DDATA", 5)]
    # tck-id-topics-ndata-payload
    assert data[0].value("Database/Answers") is False
    of_fan, of_pump = data[1:]
    # A motor without a record has no condition that was good before: the rest alone changes.
    of_records = {name for name in of_pump.metrics if name.startswith("Condition/")} - {"Condition/Stale"}
    assert of_fan.metrics.keys() == of_pump.metrics.keys() - of_records
    assert (len(of_pump.metrics), len(of_fan.metrics)) == (27, 9)
    for device in (of_fan, of_pump):
        qualities = {one["properties"][0]["values"][0]["int_value"][0] for one in device.metrics.values()}
        assert qualities == {500}


async def _tell(repository: Repository, broker: Mosquitto, directory: Path, heard: list[Heard]) -> None:
    """Tell the plant, then that the database is silent."""
    settings = settings_of(directory, broker.port, sparkplug={})
    mqtt = settings.gateways.mqtt
    assert mqtt is not None
    assert mqtt.sparkplug is not None
    context = GatewayContext(settings, repository, Event(), lambda _: None)
    feed, problems = PlantFeed(), list[str | None]()
    plain = PlainTopics(mqtt, context, feed, problems.append)
    node = EdgeNode(mqtt, mqtt.sparkplug, context, feed, problems.append)
    telling = [
        asyncio.create_task(stay_connected(part.connection, part.session, context.stop, problems.append))
        for part in (plain, node)
    ]
    state = read_plant_state(repository, now_ns=time.time_ns(), stale_after_days=3650)
    feed.put(state)
    assert await asyncio.to_thread(
        eventually, lambda: _last(heard, "statorwatch/status").get("state") == "online"
    )
    assert await asyncio.to_thread(eventually, lambda: len(_of(heard, "spBv1.0/")) == 3)
    assert _last(heard, PUMP)["quality"] == "good"
    feed.put(state.as_uncertain("the service's database does not answer"))
    assert await asyncio.to_thread(eventually, lambda: _last(heard, PUMP)["quality"] == "uncertain")
    assert await asyncio.to_thread(
        eventually, lambda: _last(heard, "statorwatch/status").get("database") == "silent"
    )
    assert await asyncio.to_thread(eventually, lambda: len(_of(heard, "spBv1.0/")) == 6)
    context.stop.set()
    await asyncio.gather(*telling)
    assert set(problems) == {None}


def _of(heard: list[Heard], prefix: str) -> list[Heard]:
    return [one for one in list(heard) if one.topic.startswith(prefix)]


def _last(heard: list[Heard], topic: str) -> dict[str, object]:
    found = [one.payload for one in list(heard) if one.topic == topic]
    return dict(json.loads(found[-1])) if found else {}
