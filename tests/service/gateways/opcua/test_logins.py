"""A login that waits for the database makes no other OPC UA client wait."""

import asyncio
import sqlite3
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

from asyncua import Client, ua

from service.configuration.settings import Settings
from service.gateways.opcua.transport import SILENT_S
from service.gateways.opcua.users import LOGINS_AT_ONCE as AT_ONCE
from service.gateways.opcua.worker_threads import LONGEST_S
from service.storage import Repository
from service.storage.records import Role
from testing.service.conditions import HEALTHY, tell
from testing.service.gateways import running_gateways
from tests.service.gateways.opcua.clients import PASSWORD, PUMP, add_user, address_of, node
from tests.service.gateways.settings import settings_of

STATE = f"{PUMP}/State"
READS = 20
LONGEST_READ_S = 0.8
"""That of a machine at a quarter of the usual speed."""

WATCHDOG_S = 1000.0
"""The client's own; it would end what waits."""


def client_of(settings: Settings, user: str | None = None) -> Client:
    """A client that is patient, not connected yet."""
    client = Client(address_of(settings), timeout=60, watchdog_intervall=WATCHDOG_S)
    if user is not None:
        client.set_user(user)
        client.set_password(PASSWORD)
    return client


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Let nobody else write into the database."""
    with closing(sqlite3.connect(folder / "statorwatch.sqlite", isolation_level=None)) as database:
        database.execute("BEGIN IMMEDIATE")
        yield
        database.rollback()


async def log_in(settings: Settings, user: str) -> str:
    """What such a user reads, or why it is not let in."""
    try:
        async with client_of(settings, user) as client:
            return str(await node(client, STATE).read_value())
    except (ua.UaStatusCodeError, ConnectionError) as refused:
        return type(refused).__name__


async def longest_read_s(client: Client, reads: int) -> float:
    """How long the slowest of some reads took, ten a second."""
    took_s = 0.0
    for _ in range(reads):
        begun_s = time.monotonic()
        assert await node(client, STATE).read_value() == "healthy"
        took_s = max(took_s, time.monotonic() - begun_s)
        await asyncio.sleep(0.1)
    return took_s


def test_a_login_waits_for_the_database_and_nobody_waits_for_the_login(
    repository: Repository, tmp_path: Path
) -> None:
    tell(repository, HEALTHY)
    add_user(repository, "vera", Role.VIEWER)
    chosen = settings_of("opcua", tmp_path, anonymous=True, unencrypted=True)

    async def work() -> None:
        async with client_of(chosen) as other:
            with locked(tmp_path):
                login = asyncio.create_task(log_in(chosen, "vera"))
                assert await longest_read_s(other, READS) < LONGEST_READ_S
                assert not login.done()
            assert await login == "healthy"

    with running_gateways(chosen):
        asyncio.run(work())


def test_logins_that_wait_too_long_are_refused_with_the_reason(
    repository: Repository, tmp_path: Path
) -> None:
    tell(repository, HEALTHY)
    chosen = settings_of("opcua", tmp_path, anonymous=True, unencrypted=True)
    assert LONGEST_S > SILENT_S  # a connection does not end because its login is looked at for long

    async def work() -> None:
        async with client_of(chosen) as other:
            with locked(tmp_path):
                logins = asyncio.gather(*(log_in(chosen, f"nobody{number}") for number in range(AT_ONCE + 2)))
                while not logins.done():
                    assert await longest_read_s(other, READS) < LONGEST_READ_S
            assert sorted(logins.result()) == ["BadTimeout"] * AT_ONCE + ["BadTooManyOperations"] * 2

    with running_gateways(chosen):
        asyncio.run(work())
