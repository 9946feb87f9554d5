"""What a broker sends is hostile: the gateway says what is wrong, and tries again."""

import asyncio
from threading import Event

import pytest
from aiomqtt import Will
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from service.configuration.gateways.mqtt import MqttSettings
from service.gateways.mqtt import broker as brokers
from service.gateways.mqtt.broker import Broker, stay_connected
from testing.ports import LOOPBACK

ACCEPTED = {"3.1.1": b"\x20\x02\x00\x00", "5": b"\x20\x03\x00\x00\x00"}
ATTEMPTS = 2


@pytest.fixture(autouse=True)
def _short_pauses(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(brokers, "SHORTEST_PAUSE_S", 0.0)
    monkeypatch.setattr(brokers, "LONGEST_PAUSE_S", 0.0)
    monkeypatch.setattr(brokers, "LOOK_S", 0.01)


@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    protocol=st.sampled_from(list(ACCEPTED)),
    is_accepted=st.booleans(),
    sent=st.binary(min_size=1, max_size=200)
    | st.tuples(st.integers(0, 255), st.binary(max_size=100)).map(
        lambda packet: bytes([packet[0], len(packet[1])]) + packet[1]
    ),
)
def test_garbled_packets_are_told_and_the_connection_is_opened_again(
    protocol: str, sent: bytes, *, is_accepted: bool
) -> None:
    begun = ACCEPTED[protocol] if is_accepted else b""
    assert len(asyncio.run(_attempts(protocol, begun + sent))) >= ATTEMPTS


async def _attempts(protocol: str, sent: bytes) -> list[str]:
    """What is said of the first attempts at a broker that sends these bytes and goes."""
    stop, problems = Event(), list[str]()

    async def answer(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        await reader.read(1)
        writer.write(sent)
        await writer.drain()
        writer.close()

    def say(problem: str | None) -> None:
        problems.append(str(problem))
        if len(problems) >= ATTEMPTS:
            stop.set()

    async with await asyncio.start_server(answer, LOOPBACK, 0) as server:
        table = {"port": server.sockets[0].getsockname()[1], "protocol": protocol, "timeout_s": 0.1}
        mqtt = MqttSettings.model_validate(table)
        will = Will("statorwatch/status", b"{}")
        await stay_connected(lambda: Broker(mqtt, will, client_id="x"), Broker.lost, stop, say)
    return problems
