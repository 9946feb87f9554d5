"""A subscription belongs to its session: nobody else mutes, changes, ends or takes it."""

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest
from asyncua import Client, ua
from asyncua.common.subscription import Subscription

from service.configuration.settings import Settings
from service.storage import Repository
from service.storage.records import Role
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.gateways import running_gateways
from tests.service.gateways.opcua.clients import PUMP, add_user, encrypted, node
from tests.service.gateways.opcua.test_logins import client_of
from tests.service.gateways.opcua.test_lost_connections import Heard
from tests.service.gateways.opcua.test_sessions import refused
from tests.service.gateways.settings import settings_of

PUBLISHING_MS = 100
LONGEST_S = 300.0
HEARS_S = 60.0
"""Longest time until a change is heard; the machine may be slow."""

INVALID = ua.StatusCodes.BadSubscriptionIdInvalid


class Follower:
    """Somebody who follows the state of the pump."""

    def __init__(self, client: Client) -> None:
        self.client = client
        self.heard = Heard()
        self.subscription: Subscription
        self.item = 0

    @property
    def number(self) -> int:
        """That of the subscription."""
        assert self.subscription.subscription_id is not None
        return int(self.subscription.subscription_id)

    async def begin(self) -> "Follower":
        """Connect, and follow."""
        await self.client.connect()
        self.subscription = await self.client.create_subscription(PUBLISHING_MS, self.heard)
        self.item = await self.subscription.subscribe_data_change(node(self.client, f"{PUMP}/State"))
        await self.hears("healthy")
        return self

    async def hears(self, state: str) -> None:
        """Wait until it is told so."""
        await asyncio.wait_for(self.heard.until(state), HEARS_S)


def served(
    repository: Repository,
    folder: Path,
    work: Callable[[Settings], Awaitable[None]],
    *,
    is_open: bool = True,
) -> None:
    """Let clients of a served plant work."""
    tell(repository, HEALTHY)
    for name in ("anna", "bert"):
        add_user(repository, name, Role.VIEWER)
    settings = settings_of("opcua", folder, anonymous=is_open, unencrypted=is_open)

    async def run() -> None:
        await work(settings)

    with running_gateways(settings):
        asyncio.run(asyncio.wait_for(run(), LONGEST_S))


def codes(results: Any) -> list[int]:
    return [one.value for one in results]


async def tries(client: Client, number: int, item: int) -> None:
    """Try all that can be done to a subscription, as somebody who has another one."""
    session = client.uaclient
    muted = ua.SetPublishingModeParameters(PublishingEnabled=False, SubscriptionIds=[number])
    assert codes(await session.set_publishing_mode(muted)) == [INVALID]
    assert codes(await session.delete_subscriptions([number])) == [INVALID]
    transfer = ua.TransferSubscriptionsParameters(SubscriptionIds=[number], SendInitialValues=False)
    assert [one.StatusCode.value for one in await session.transfer_subscriptions(transfer)] == [INVALID]
    disabled = ua.SetMonitoringModeParameters(
        SubscriptionId=number, MonitoringMode=ua.MonitoringMode.Disabled, MonitoredItemIds=[item]
    )
    create = ua.CreateMonitoredItemsParameters(SubscriptionId=number, ItemsToCreate=[])
    modify = ua.ModifyMonitoredItemsParameters(SubscriptionId=number, ItemsToModify=[])
    delete = ua.DeleteMonitoredItemsParameters(SubscriptionId=number, MonitoredItemIds=[item])
    for asked in (
        session.update_subscription(ua.ModifySubscriptionParameters(SubscriptionId=number)),
        session.set_monitoring_mode(disabled),
        session.create_monitored_items(create),
        session.modify_monitored_items(modify),
        session.delete_monitored_items(delete),
        session.session.republish(number, 1),
    ):
        assert await refused(asked) == "BadSubscriptionIdInvalid"


async def acknowledged(client: Client, number: int) -> list[int]:
    """What comes of acknowledging the first answer of a subscription."""
    own = await client.create_subscription(PUBLISHING_MS, Heard())
    ack = ua.SubscriptionAcknowledgement(SubscriptionId=number, SequenceNumber=1)
    response = await client.uaclient.publish([ack])
    await own.delete()
    return codes(response.Parameters.Results)


@pytest.mark.parametrize("other", ["bert", None])
def test_nobody_else_touches_a_subscription(
    repository: Repository, tmp_path: Path, other: str | None
) -> None:
    async def work(settings: Settings) -> None:
        anna = await Follower(client_of(settings, "anna")).begin()
        async with client_of(settings, other) as thief:
            await tries(thief, anna.number, anna.item)
            assert await acknowledged(thief, anna.number) == [INVALID]
            assert await refused(thief.uaclient.publish([])) == "BadNoSubscription"
            own = await thief.create_subscription(PUBLISHING_MS, Heard())
            assert own.subscription_id is not None
            mixed = [anna.number, own.subscription_id, anna.number]
            assert codes(await thief.uaclient.delete_subscriptions(mixed)) == [INVALID, 0, INVALID]
        await asyncio.to_thread(tell, repository, FAULT)
        await anna.hears("fault")
        await anna.client.disconnect()

    served(repository, tmp_path, work)


async def moved(own: Follower, other: Client) -> Heard:
    """Have the other client's session take over the subscription, as a client that begins anew does."""
    heard = Heard()
    asked = ua.TransferSubscriptionsParameters(SubscriptionIds=[own.number], SendInitialValues=False)
    (result,) = await other.uaclient.transfer_subscriptions(asked)
    assert result.StatusCode.value == ua.StatusCodes.Good

    def tell_states(result: ua.PublishResult) -> None:
        for told in result.NotificationMessage.NotificationData:
            if isinstance(told, ua.DataChangeNotification):
                heard.states += [item.Value.Value.Value for item in told.MonitoredItems]

    other.uaclient.session._subscription_callbacks[own.number] = tell_states
    other.uaclient.session.ensure_publish_loop()
    return heard


@pytest.mark.parametrize("is_closed", [False, True])
def test_its_own_client_takes_it_to_another_session(
    repository: Repository, tmp_path: Path, *, is_closed: bool
) -> None:
    async def work(settings: Settings) -> None:
        before = await Follower(await encrypted(settings, "anna")).begin()
        if is_closed:
            await before.client.uaclient.close_session(delete_subscriptions=False)
        async with await encrypted(settings, "anna") as after:
            heard = await moved(before, after)
            await asyncio.to_thread(tell, repository, FAULT)
            await asyncio.wait_for(heard.until("fault"), HEARS_S)
            assert before.heard.states == ["healthy"]
            if not is_closed:
                assert codes(await before.client.uaclient.delete_subscriptions([before.number])) == [INVALID]
            assert codes(await after.uaclient.delete_subscriptions([before.number])) == [0]
        await before.client.disconnect()

    served(repository, tmp_path, work, is_open=False)


def test_a_client_with_another_certificate_or_user_takes_nothing(
    repository: Repository, tmp_path: Path
) -> None:
    async def work(settings: Settings) -> None:
        anna = await Follower(await encrypted(settings, "anna")).begin()
        async with await encrypted(settings, "bert") as same_certificate:
            await tries(same_certificate, anna.number, anna.item)
        (settings.data_directory / "client").rename(settings.data_directory / "anna's client")
        async with await encrypted(settings, "anna") as same_user:
            await tries(same_user, anna.number, anna.item)
        await asyncio.to_thread(tell, repository, FAULT)
        await anna.hears("fault")
        await anna.client.disconnect()

    served(repository, tmp_path, work, is_open=False)


@pytest.mark.parametrize("user", ["anna", None])
def test_what_an_unknown_client_leaves_behind_is_ended(
    repository: Repository, tmp_path: Path, user: str | None
) -> None:
    async def work(settings: Settings) -> None:
        before = await Follower(client_of(settings, user)).begin()
        await before.client.uaclient.close_session(delete_subscriptions=False)
        before.client.disconnect_socket()
        async with client_of(settings, user) as after:
            asked = ua.TransferSubscriptionsParameters(
                SubscriptionIds=[before.number], SendInitialValues=False
            )
            (result,) = await after.uaclient.transfer_subscriptions(asked)
            expected = INVALID if user is None else ua.StatusCodes.Good
            assert result.StatusCode.value == expected

    served(repository, tmp_path, work)
