"""What runs together ends together, and a broker that is gone first leaves nothing behind."""

import asyncio
import gc
from pathlib import Path

import pytest
from aiomqtt import MqttError, Will

from service.gateways.mqtt.broker import Broker, first_of
from testing.service.mosquitto import Mosquitto
from tests.service.gateways.mqtt.conftest import settings_of


def test_who_forgets_that_it_was_cancelled_is_cancelled_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("service.gateways.mqtt.broker.LOOK_S", 0.01)
    forgotten = []

    async def forgetful() -> None:
        try:
            await asyncio.Event().wait()
        except asyncio.CancelledError:
            forgotten.append("once")
        await asyncio.Event().wait()

    async def ends() -> None:
        await asyncio.sleep(0)

    asyncio.run(asyncio.wait_for(first_of(forgetful(), ends()), 10))
    assert forgotten == ["once"]


def test_nothing_is_left_unread_of_a_broker_that_is_gone_first(broker: Mosquitto, tmp_path: Path) -> None:
    """Asyncio told of an exception that nobody retrieved, in the log of a service that was stopped."""
    mqtt = settings_of(tmp_path, broker.port).gateways.mqtt
    assert mqtt is not None
    complaints: list[str] = []

    async def stay_until_it_is_gone() -> None:
        asyncio.get_running_loop().set_exception_handler(
            lambda _loop, context: complaints.append(str(context["message"]))
        )
        connection: Broker | None = Broker(mqtt, Will("status", b"gone"), client_id="test")
        assert connection is not None
        async with connection:
            await asyncio.to_thread(broker.stop)
            with pytest.raises(MqttError):
                await asyncio.wait_for(connection.lost(), 30)
        connection = None
        gc.collect()

    asyncio.run(stay_until_it_is_gone())
    assert complaints == []
