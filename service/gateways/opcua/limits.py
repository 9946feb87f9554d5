"""How much a client may ask for at a time, and hold: what is refused is what the server tells of itself."""

from collections.abc import Mapping, Sequence
from typing import Final

from asyncua import Server, ua
from asyncua.common.utils import ServiceError

SUBSCRIPTIONS: Final = 10
"""Of one client; as many for each connection that the settings allow."""

MONITORED_ITEMS: Final = 30_000
"""Of one client, enough for one that follows all 22 variables of 1,000 motors, and their relays."""

SHORTEST_MS, LONGEST_MS = 100.0, 3_600_000.0
"""Publishing intervals. The plant's state is looked at twice a second."""

QUEUE: Final = 1_000
"""Changes of one monitored item that wait for its client."""

UNACKNOWLEDGED: Final = 100
"""Answers of a subscription that are kept for a client that may ask for them again."""

READ, HISTORY_READ, WRITE = "MaxNodesPerRead", "MaxNodesPerHistoryReadData", "MaxNodesPerWrite"
BROWSE, TRANSLATE = "MaxNodesPerBrowse", "MaxNodesPerTranslateBrowsePathsToNodeIds"
CALL, MONITOR = "MaxNodesPerMethodCall", "MaxMonitoredItemsPerCall"

OPERATIONS: Final[Mapping[str, int]] = {
    READ: 10_000,
    HISTORY_READ: 100,
    "MaxNodesPerHistoryReadEvents": 100,
    WRITE: 10_000,
    BROWSE: 100,  # a folder may have 1,000 motors
    TRANSLATE: 1_000,
    CALL: 100,
    MONITOR: 10_000,
}
"""Operations of one request, by the names of OperationLimits (OPC 10000-5)."""

_CAPABILITIES: Final = "Server_ServerCapabilities_"


def check_operations(name: str, asked: Sequence[object] | None) -> None:
    """Refuse a request that asks for more at once than is told. Raises ServiceError."""
    if asked is not None and len(asked) > OPERATIONS[name]:
        raise ServiceError(ua.StatusCodes.BadTooManyOperations)


def interval_ms(wanted_ms: float) -> float:
    """Return the publishing interval for one that is asked for, which may be no number at all."""
    return min(wanted_ms, LONGEST_MS) if wanted_ms >= SHORTEST_MS else SHORTEST_MS


def queue_size(wanted: int) -> int:
    """Return the size of a queue for one that is asked for; 0 asks for the largest."""
    return min(wanted, QUEUE) if wanted > 0 else QUEUE


async def set_limits(server: Server, max_connections: int) -> None:
    """Have the server bound what it holds, and say so."""
    inner = server.iserver
    inner.max_connections = max_connections
    inner.max_subscriptions = SUBSCRIPTIONS * max_connections
    inner.max_unacked_messages_per_subscription = UNACKNOWLEDGED
    inner.max_monitored_item_queue_size = QUEUE
    numbers = {f"OperationLimits_{name}": most for name, most in OPERATIONS.items()}
    numbers |= {
        "MaxSubscriptions": inner.max_subscriptions,
        "MaxSubscriptionsPerSession": SUBSCRIPTIONS,
        "MaxMonitoredItemsPerSubscription": MONITORED_ITEMS,
        "MaxMonitoredItemsQueueSize": QUEUE,
    }
    values = {name: ua.Variant(most, ua.VariantType.UInt32) for name, most in numbers.items()}
    values["MinSupportedSampleRate"] = ua.Variant(SHORTEST_MS, ua.VariantType.Double)
    for name, value in values.items():
        node_id = ua.NodeId(getattr(ua.ObjectIds, f"{_CAPABILITIES}{name}"))
        await server.write_attribute_value(node_id, ua.DataValue(value))
