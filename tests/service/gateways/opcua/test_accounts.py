"""What becomes of the OPC UA session of a user whose account is deleted, disabled or changed."""

import asyncio
from collections.abc import Callable
from pathlib import Path

import pytest
from asyncua import Client, ua

from service.access.passwords import hashed
from service.configuration.settings import Settings
from service.gateways.opcua.account_watch import LOOK_S
from service.storage import Repository
from service.storage.records import Role
from testing.service.accounts import TESTS
from testing.service.conditions import HEALTHY, tell
from testing.service.gateways import running_gateways
from testing.service.plants import NOW_NS
from tests.service.gateways.opcua.clients import PUMP, add_user, encrypted, node
from tests.service.gateways.settings import settings_of

Change = Callable[[Repository], object]


def make_again(repository: Repository) -> None:
    repository.delete_user("otto", by=TESTS, now_ns=NOW_NS)
    add_user(repository, "otto", Role.OPERATOR, now_ns=NOW_NS + 1)


ENDS_S = 5 * LOOK_S
"""Longest time after which a session has ended; the machine may be slow."""

CHANGES: dict[str, Change] = {
    "deleted": lambda repository: repository.delete_user("otto", by=TESTS, now_ns=NOW_NS),
    "disabled": lambda repository: repository.change_user("otto", disabled=True, by=TESTS, now_ns=NOW_NS),
    "other roles": lambda repository: repository.change_user(
        "otto", roles={Role.VIEWER}, by=TESTS, now_ns=NOW_NS
    ),
    "another password": lambda repository: repository.set_password(
        "otto", hashed("another horse battery"), by=TESTS, now_ns=NOW_NS + 1
    ),
    "deleted and made again": make_again,
    "logged out everywhere": lambda repository: repository.end_sessions_of("otto", by=TESTS, now_ns=NOW_NS),
}


async def trigger(client: Client) -> str:
    """Have PUMP-A1 recorded, or tell why not."""
    try:
        await node(client, "service").call_method("2:TriggerRecording", "PUMP-A1")
    except (ua.UaStatusCodeError, ConnectionError) as refused:
        return type(refused).__name__
    return "requested"


async def until_ended(client: Client) -> None:
    """Read until nothing is answered any more."""
    while True:
        try:
            await node(client, f"{PUMP}/State").read_value()
        except ConnectionError:
            return
        await asyncio.sleep(0.05)


@pytest.mark.parametrize("change", [pytest.param(change, id=name) for name, change in CHANGES.items()])
def test_a_session_ends_with_what_its_user_might(
    repository: Repository, tmp_path: Path, change: Change
) -> None:
    tell(repository, HEALTHY)
    add_user(repository, "otto", Role.OPERATOR)
    add_user(repository, "olga", Role.OPERATOR)
    chosen = settings_of("opcua", tmp_path)

    async def work(settings: Settings) -> None:
        async with await encrypted(settings, "olga") as other:
            client = await encrypted(settings, "otto")
            await client.connect()
            assert await trigger(client) == "requested"
            await asyncio.to_thread(change, repository)
            assert await trigger(client) in ("BadUserAccessDenied", "ConnectionError")
            await asyncio.wait_for(until_ended(client), ENDS_S)
            assert await trigger(other) == "requested"

    with running_gateways(chosen):
        asyncio.run(work(chosen))
    assert len(repository.recording_requests(motor="PUMP-A1", limit=9).items) == 2


def test_a_session_that_only_hears_of_changes_ends_too(repository: Repository, tmp_path: Path) -> None:
    tell(repository, HEALTHY)
    add_user(repository, "vera", Role.VIEWER)
    chosen = settings_of("opcua", tmp_path)
    lost = asyncio.Event()

    class Seen:
        def datachange_notification(self, *_told: object) -> None:
            pass

    async def on_lost(_error: Exception) -> None:
        lost.set()

    async def work() -> None:
        client = await encrypted(chosen, "vera")
        client.connection_lost_callback = on_lost
        await client.connect()
        subscription = await client.create_subscription(100, Seen())
        await subscription.subscribe_data_change(node(client, f"{PUMP}/State"))
        await asyncio.to_thread(repository.delete_user, "vera", by=TESTS, now_ns=NOW_NS)
        await asyncio.wait_for(lost.wait(), ENDS_S)

    with running_gateways(chosen):
        asyncio.run(work())
