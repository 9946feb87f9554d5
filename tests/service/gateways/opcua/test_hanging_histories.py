"""Clients whose HistoryRead waits for a database that hangs make nobody wait, and no value stays good."""

import asyncio
import time
from contextlib import AsyncExitStack
from pathlib import Path

import pytest
from asyncua import Client, ua

from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings
from service.gateways.opcua.history import READS_AT_ONCE
from service.gateways.plant_state.following import SILENCE_S
from service.storage import Repository, connect
from service.storage.records import Role
from testing.ports import free_port
from testing.service.gateways import healthy_plant_on_postgresql, running_gateways
from testing.service.postgresql import PostgresServer
from tests.service.gateways.opcua.clients import PUMP, add_user, node
from tests.service.gateways.opcua.test_history_reads import FAR, LOAD, LONG_AGO, details_of
from tests.service.gateways.opcua.test_logins import client_of

CLIENTS = 40
LATER_S = 4.0
"""A gateway looks at what was read twice a second."""

LONGEST_READ_S = 2.0
"""That of a machine at a tenth of the usual speed."""

LONGEST_S = 180.0


async def is_good(client: Client) -> bool:
    found = await node(client, f"{PUMP}/State").read_data_value(raise_on_bad_status=False)
    return bool(found.StatusCode.value == ua.StatusCodes.Good)


async def keep_reading(client: Client, said: list[str]) -> None:
    """Ask for the history again and again, and note what comes of it."""
    while True:
        try:
            result = await node(client, LOAD).history_read(details_of(LONG_AGO, FAR))
            said.append(result.StatusCode.name)
        except ua.UaStatusCodeError as refused:
            said.append(type(refused).__name__)


async def longest_good_s(client: Client) -> float:
    """Read until a value is not good any more. Return for how long it was, at most."""
    begun_s = time.monotonic()
    while True:
        asked_s = time.monotonic()
        good = await is_good(client)
        assert time.monotonic() - asked_s < LONGEST_READ_S
        if not good or asked_s - begun_s > 3 * SILENCE_S:
            return time.monotonic() - begun_s
        await asyncio.sleep(0.1)


async def until_good(client: Client) -> None:
    while not await is_good(client):
        await asyncio.sleep(0.1)


async def work(settings: Settings, postgresql: PostgresServer) -> None:
    said: list[str] = []
    async with AsyncExitStack() as clients:
        watching, *readers = [
            await clients.enter_async_context(client_of(settings, None if number else "vera"))
            for number in range(CLIENTS + 1)
        ]
        await until_good(watching)
        postgresql.freeze()
        try:
            reading = [asyncio.create_task(keep_reading(reader, said)) for reader in readers]
            good_s = await longest_good_s(watching)
        finally:
            postgresql.thaw()
        assert good_s < SILENCE_S + LATER_S
        # Those whose turn it is hang on, others do not come to it.
        assert said.count("BadTimeout") >= READS_AT_ONCE, said
        assert said.count("BadTooManyOperations") >= CLIENTS - READS_AT_ONCE, said
        await until_good(watching)
        while "GoodNoData" not in said:
            await asyncio.sleep(0.1)
        for one in reading:
            one.cancel()
        await asyncio.gather(*reading, return_exceptions=True)


@pytest.mark.campaign
def test_histories_that_hang_leave_no_value_good(tmp_path: Path) -> None:
    with healthy_plant_on_postgresql() as (postgresql, url):
        engine = connect(url)
        add_user(Repository(engine), "vera", Role.VIEWER)
        engine.dispose()
        table = {"opcua": {"port": free_port(), "anonymous": True, "unencrypted": True}}
        settings = Settings(
            data_directory=tmp_path,
            database_url=url,
            stale_after_days=3650,
            gateways=GatewaysSettings.model_validate(table),
        )
        with running_gateways(settings):
            asyncio.run(asyncio.wait_for(work(settings, postgresql), LONGEST_S))
