"""A hundred clients that work at once are all served, by each gateway that bounds them by setting only."""

import asyncio
import socket
import struct
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import AsyncExitStack, ExitStack, closing
from pathlib import Path
from typing import TypeVar

import pytest
from asyncua import Client

from service.gateways.iec104.points import BLOCK, FIRST
from service.storage import Repository
from testing.ports import LOOPBACK
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.gateways import running_gateways
from testing.service.iec104_master import Master
from testing.waiting import wait_until
from tests.service.gateways.modbus import test_modbus as modbus
from tests.service.gateways.opcua import clients as opcua
from tests.service.gateways.settings import port_of, settings_of

Found = TypeVar("Found")

CLIENTS = 100
THREADS = 20


def at_once(ask: Callable[[int], Found]) -> list[Found]:
    with ThreadPoolExecutor(THREADS) as pool:
        return list(pool.map(ask, range(CLIENTS)))


@pytest.mark.campaign
def test_a_hundred_clients_of_opc_ua_are_told_of_a_change(repository: Repository, tmp_path: Path) -> None:
    tell(repository, HEALTHY)
    chosen = settings_of("opcua", tmp_path, anonymous=True, unencrypted=True)
    told: dict[int, object] = {}

    class Seen:
        def __init__(self, number: int) -> None:
            self.number = number

        def datachange_notification(self, _which: object, said: object, _data: object) -> None:
            told[self.number] = said

    async def work() -> None:
        async with AsyncExitStack() as clients:
            for number in range(CLIENTS):
                client = await clients.enter_async_context(Client(opcua.address_of(chosen), timeout=30))
                subscription = await client.create_subscription(100, Seen(number))
                await subscription.subscribe_data_change(opcua.node(client, f"{opcua.PUMP}/State"))
            await asyncio.to_thread(tell, repository, FAULT)
            while list(told.values()).count("fault") < CLIENTS:
                await asyncio.sleep(0.05)

    with running_gateways(chosen):
        asyncio.run(asyncio.wait_for(work(), 120))


@pytest.mark.campaign
def test_a_hundred_stations_of_iec_104_are_told_of_a_change(repository: Repository, tmp_path: Path) -> None:
    tell(repository, HEALTHY)
    chosen = settings_of("iec104", tmp_path, max_connections=CLIENTS)
    pump = FIRST + BLOCK + 1
    with running_gateways(chosen), ExitStack() as open_ones:
        stations = [
            open_ones.enter_context(closing(Master(LOOPBACK, port_of(chosen)))) for _ in range(CLIENTS)
        ]
        at_once(lambda number: stations[number].interrogate())
        assert [one.told[pump].value for one in stations] == [0] * CLIENTS
        tell(repository, FAULT)

        def has_heard(number: int) -> bool:
            while stations[number].told[pump].value == 0:
                stations[number].next_change()
            return True

        assert all(at_once(has_heard))


def test_a_hundred_clients_of_modbus_read_the_same(repository: Repository, tmp_path: Path) -> None:
    tell(repository, FAULT)
    chosen = settings_of("modbus", tmp_path, max_connections=CLIENTS)
    address = (LOOPBACK, port_of(chosen))
    read_state = struct.pack(">HHHBBHH", 1, 0, 6, 1, 4, modbus.PUMP, 1)
    with running_gateways(chosen), ExitStack() as open_ones:
        links = [
            open_ones.enter_context(socket.create_connection(address, timeout=20)) for _ in range(CLIENTS)
        ]

        def answer(number: int) -> bytes:
            links[number].sendall(read_state)
            return links[number].recv(260)

        wait_until(lambda: answer(0)[-2:] == b"\x00\x03", "the state of the fault")
        assert {said[-2:] for said in at_once(answer)} == {b"\x00\x03"}
