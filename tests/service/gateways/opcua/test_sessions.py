"""A session of OPC UA belongs to one connection, one client and one user."""

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest
from asyncua import Client, ua

from service.configuration.settings import Settings
from service.storage import Repository
from service.storage.records import Role
from testing.service.conditions import HEALTHY, tell
from testing.service.gateways import running_gateways
from tests.service.gateways.opcua.clients import PASSWORD, PUMP, add_user, address_of, encrypted, node
from tests.service.gateways.opcua.test_lost_connections import subscribed
from tests.service.gateways.settings import settings_of

ENDS_S = 10.0
"""Longest time until a connection has ended; the machine may be slow."""


def token_of(client: Client) -> ua.NodeId:
    return client.uaclient.session.authentication_token


async def state_of(client: Client) -> str:
    return str(await node(client, f"{PUMP}/State").read_value())


async def until_ended(client: Client) -> None:
    """Read until the connection has ended."""
    while True:
        try:
            await state_of(client)
        except ConnectionError:
            return
        await asyncio.sleep(0.05)


async def refused(asked: Awaitable[object]) -> str:
    """Why it is refused."""
    with pytest.raises(ua.UaStatusCodeError) as error:
        await asked
    return type(error.value).__name__


def served(
    repository: Repository, folder: Path, work: Callable[[Settings], Awaitable[None]], *, is_open: bool
) -> None:
    """Let clients of a served plant work."""
    tell(repository, HEALTHY)
    for name in ("vera", "victor"):
        add_user(repository, name, Role.VIEWER)
    settings = settings_of("opcua", folder, anonymous=is_open, unencrypted=is_open)
    with running_gateways(settings):
        asyncio.run(asyncio.wait_for(_run(work, settings), 120.0))


async def _run(work: Callable[[Settings], Awaitable[None]], settings: Settings) -> None:
    await work(settings)


def logging_in(settings: Settings, user: str | None) -> Client:
    """An unencrypted client, not connected yet."""
    client = Client(address_of(settings))
    if user is not None:
        client.set_user(user)
        client.set_password(PASSWORD)
    return client


def test_nobody_guesses_a_token(repository: Repository, tmp_path: Path) -> None:
    async def work(settings: Settings) -> None:
        async with Client(address_of(settings)) as one, Client(address_of(settings)) as another:
            tokens = {bytes(token_of(client).Identifier) for client in (one, another)}
        assert [len(token) for token in tokens] == [32, 32]

    served(repository, tmp_path, work, is_open=True)


def test_a_request_with_another_token_is_refused(repository: Repository, tmp_path: Path) -> None:
    async def work(settings: Settings) -> None:
        async with Client(address_of(settings)) as one, Client(address_of(settings)) as another:
            own = token_of(one)
            for wrong in (token_of(another), ua.NodeId(), ua.NodeId(1000)):
                one.uaclient.session.restore_authentication_token(wrong)
                assert await refused(state_of(one)) == "BadSessionIdInvalid"
            one.uaclient.session.restore_authentication_token(own)
            assert await state_of(one) == "healthy"

    served(repository, tmp_path, work, is_open=True)


def test_a_connection_has_one_session_at_a_time(repository: Repository, tmp_path: Path) -> None:
    async def work(settings: Settings) -> None:
        async with Client(address_of(settings)) as client:
            assert await refused(client.create_session()) == "BadTooManySessions"
            assert await state_of(client) == "healthy"
        async with Client(address_of(settings)) as client:
            await client.close_session()
            await client.create_session()
            await client.activate_session()
            assert await state_of(client) == "healthy"

    served(repository, tmp_path, work, is_open=True)


@pytest.mark.parametrize("other", ["victor", None])
def test_nobody_else_takes_a_session_over(repository: Repository, tmp_path: Path, other: str | None) -> None:
    async def work(settings: Settings) -> None:
        owner = logging_in(settings, "vera")
        await subscribed(owner, tmp_path / "owner.json")
        thief = logging_in(settings, other)
        await thief.connect_sessionless()
        thief.uaclient.session.restore_authentication_token(token_of(owner))
        asked = thief.activate_session(username=other, password=None if other is None else PASSWORD)
        assert await refused(asked) == "BadIdentityChangeNotSupported"
        await thief.disconnect_sessionless()
        assert await state_of(owner) == "healthy"
        await owner.disconnect()

    served(repository, tmp_path, work, is_open=True)


def test_no_client_with_another_certificate_takes_a_session_over(
    repository: Repository, tmp_path: Path
) -> None:
    async def work(settings: Settings) -> None:
        owner = await encrypted(settings, "vera")
        await subscribed(owner, tmp_path / "owner.json")
        (settings.data_directory / "client").rename(settings.data_directory / "owner")
        thief = await encrypted(settings, "vera")
        (tmp_path / "thief.json").write_bytes((tmp_path / "owner.json").read_bytes())
        thief.session_state_path = tmp_path / "thief.json"
        taken = token_of(owner)
        await thief.connect()  # it has to begin a session of its own
        assert token_of(thief) != taken
        assert await state_of(owner) == "healthy"
        await thief.disconnect()
        await owner.disconnect()

    served(repository, tmp_path, work, is_open=False)


def test_its_own_client_takes_it_over_and_the_old_connection_ends(
    repository: Repository, tmp_path: Path
) -> None:
    async def work(settings: Settings) -> None:
        before = await encrypted(settings, "vera")
        await subscribed(before, tmp_path / "session.json")
        token = token_of(before)
        again = await encrypted(settings, "vera")
        again.session_state_path = tmp_path / "session.json"
        await again.connect()
        assert token_of(again) == token
        await asyncio.wait_for(until_ended(before), ENDS_S)
        assert await state_of(again) == "healthy"
        await again.disconnect()

    served(repository, tmp_path, work, is_open=False)
