"""What a client may ask for at a time, and hold, is bounded, and the server says so."""

import asyncio
from collections.abc import Awaitable, Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest
from asyncua import Client, ua

from service.configuration.settings import Settings
from service.gateways.opcua import limits
from service.storage import Repository
from testing.service.conditions import HEALTHY, tell
from testing.service.gateways import running_gateways
from tests.service.gateways.opcua.clients import PUMP, node
from tests.service.gateways.opcua.test_logins import client_of
from tests.service.gateways.opcua.test_lost_connections import Heard
from tests.service.gateways.opcua.test_sessions import refused, state_of
from tests.service.gateways.settings import settings_of

LEVEL = f"{PUMP}/FaultLevel"
LONGEST_S = 300.0
CAPABILITIES = "Server_ServerCapabilities_"


@pytest.fixture
def settings(repository: Repository, tmp_path: Path) -> Iterator[Settings]:
    """Of a server at which anybody may look, without encryption."""
    tell(repository, HEALTHY)
    chosen = settings_of("opcua", tmp_path, anonymous=True, unencrypted=True, max_connections=20)
    with running_gateways(chosen):
        yield chosen


def looking(settings: Settings, look: Callable[[Client], Awaitable[Any]]) -> Any:
    """What a patient client sees."""

    async def ask() -> Any:
        async with client_of(settings) as client:
            return await look(client)

    return asyncio.run(asyncio.wait_for(ask(), LONGEST_S))


async def told(client: Client, name: str) -> Any:
    """What the server says of itself."""
    return await client.get_node(ua.NodeId(getattr(ua.ObjectIds, f"{CAPABILITIES}{name}"))).read_value()


def history_of(nodes: Sequence[ua.NodeId]) -> ua.HistoryReadParameters:
    details = ua.ReadRawModifiedDetails(StartTime=ua.get_win_epoch(), EndTime=ua.get_win_epoch())
    return ua.HistoryReadParameters(
        HistoryReadDetails=details,
        ReleaseContinuationPoints=False,
        NodesToRead=[ua.HistoryReadValueId(NodeId=one) for one in nodes],
    )


def reads_of(nodes: Sequence[ua.NodeId]) -> ua.ReadParameters:
    return ua.ReadParameters(NodesToRead=[ua.ReadValueId(one, ua.AttributeIds.Value) for one in nodes])


def items_of(subscription: int, nodes: Sequence[ua.NodeId], queue: int = 1) -> Any:
    items = [
        ua.MonitoredItemCreateRequest(
            ItemToMonitor=ua.ReadValueId(one, ua.AttributeIds.Value),
            MonitoringMode=ua.MonitoringMode.Reporting,
            RequestedParameters=ua.MonitoringParameters(ClientHandle=number, QueueSize=queue),
        )
        for number, one in enumerate(nodes)
    ]
    return ua.CreateMonitoredItemsParameters(SubscriptionId=subscription, ItemsToCreate=items)


def test_a_request_for_more_than_is_told_is_refused(settings: Settings) -> None:
    async def ask(client: Client) -> None:
        session = client.uaclient
        one = node(client, LEVEL).nodeid
        own = await client.create_subscription(1000, Heard())
        assert own.subscription_id is not None
        number = own.subscription_id
        call = ua.CallMethodRequest(ObjectId=one, MethodId=one, InputArguments=[])  # it is no method
        asking: dict[str, Callable[[list[ua.NodeId]], Awaitable[Any]]] = {
            limits.READ: lambda nodes: session.read(reads_of(nodes)),
            limits.HISTORY_READ: lambda nodes: session.history_read(history_of(nodes)),
            limits.BROWSE: lambda nodes: client.browse_nodes([client.get_node(each) for each in nodes]),
            limits.CALL: lambda nodes: session.call([call] * len(nodes)),
            limits.MONITOR: lambda nodes: session.create_monitored_items(items_of(number, nodes)),
        }
        for name, asks in asking.items():
            most = await told(client, f"OperationLimits_{name}")
            assert most == limits.OPERATIONS[name]
            if most <= 100:
                assert len(await asks([one] * most)) == most, name
            assert await refused(asks([one] * (most + 1))) == "BadTooManyOperations", name
        assert await state_of(client) == "healthy"

    looking(settings, ask)


@pytest.mark.parametrize(
    ("wanted_ms", "revised_ms"), [(0.0, 100.0), (1.0, 100.0), (float("nan"), 100.0), (250.0, 250.0)]
)
def test_no_client_is_told_more_often_than_ten_times_a_second(
    settings: Settings, wanted_ms: float, revised_ms: float
) -> None:
    async def ask(client: Client) -> float:
        asked = ua.CreateSubscriptionParameters(
            RequestedPublishingInterval=wanted_ms, RequestedLifetimeCount=100, RequestedMaxKeepAliveCount=10
        )
        made = await client.uaclient.create_subscription(asked, callback=lambda _result: None)
        return float(made.RevisedPublishingInterval)

    assert looking(settings, ask) == revised_ms


def test_a_session_has_so_many_subscriptions_and_no_more(settings: Settings) -> None:
    async def ask(client: Client) -> None:
        most = await told(client, "MaxSubscriptionsPerSession")
        assert most == limits.SUBSCRIPTIONS
        assert await told(client, "MaxSubscriptions") == 20 * most
        made = [await client.create_subscription(1000, Heard()) for _ in range(most)]
        assert await refused(client.create_subscription(1000, Heard())) == "BadTooManySubscriptions"
        async with Client(str(client.server_url.geturl())) as other:  # it has room of its own
            await other.create_subscription(1000, Heard())
        await made[0].delete()
        await client.create_subscription(1000, Heard())

    looking(settings, ask)


def test_a_queue_is_no_longer_than_told(settings: Settings) -> None:
    async def ask(client: Client) -> None:
        own = await client.create_subscription(1000, Heard())
        assert own.subscription_id is not None
        most = await told(client, "MaxMonitoredItemsQueueSize")
        for wanted, revised in ((0, most), (2**32 - 1, most), (7, 7)):
            asked = items_of(own.subscription_id, [node(client, LEVEL).nodeid], wanted)
            (made,) = await client.uaclient.create_monitored_items(asked)
            assert made.RevisedQueueSize == revised
            parameters = ua.MonitoringParameters(QueueSize=wanted)
            changed = ua.ModifyMonitoredItemsParameters(
                SubscriptionId=own.subscription_id,
                ItemsToModify=[ua.MonitoredItemModifyRequest(made.MonitoredItemId, parameters)],
            )
            (modified,) = await client.uaclient.modify_monitored_items(changed)
            assert modified.RevisedQueueSize == revised

    looking(settings, ask)


@pytest.mark.campaign
def test_a_session_has_so_many_monitored_items_and_no_more(settings: Settings) -> None:
    async def ask(client: Client) -> None:
        most = await told(client, "MaxMonitoredItemsPerSubscription")
        assert most == limits.MONITORED_ITEMS > 22 * 1000
        at_once = 5000
        assert most % at_once == 0
        made = [await client.create_subscription(10_000, Heard()) for _ in range(2)]
        state = node(client, f"{PUMP}/State").nodeid
        for number in range(most // at_once):
            asked = items_of(int(made[number % 2].subscription_id or 0), [state] * at_once)
            results = await client.uaclient.create_monitored_items(asked)
            assert {one.StatusCode.value for one in results} == {ua.StatusCodes.Good}
        one_more = items_of(int(made[0].subscription_id or 0), [state])
        (result,) = await client.uaclient.create_monitored_items(one_more)
        assert result.StatusCode.value == ua.StatusCodes.BadTooManyMonitoredItems
        await made[1].delete()
        (result,) = await client.uaclient.create_monitored_items(one_more)
        assert result.StatusCode.value == ua.StatusCodes.Good

    looking(settings, ask)
