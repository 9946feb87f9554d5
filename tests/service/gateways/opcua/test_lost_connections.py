"""What an OPC UA client that lost its connection is told when it comes back to its session."""

import asyncio
from pathlib import Path
from typing import Any

from asyncua import Client, ua

from scl import Address
from service.configuration.settings import Settings
from service.storage import Repository
from testing.ports import LOOPBACK, free_port
from testing.service.conditions import FAULT, HEALTHY, tell
from testing.service.gateways import running_gateways
from testing.tcp_proxy import Proxy
from testing.waiting import eventually
from tests.service.gateways.opcua.clients import PUMP, address_of, node, value
from tests.service.gateways.settings import port_of, settings_of

PUBLISHING_MS = 100
SESSION_MS = 60_000
WAITS_S = 30.0


class Heard:
    """The states that a subscription told."""

    def __init__(self) -> None:
        self.states: list[str] = []

    def datachange_notification(self, _which: Any, said: str, _data: Any) -> None:
        self.states.append(said)

    async def until(self, state: str) -> None:
        while state not in self.states:
            await asyncio.sleep(0.05)


async def subscribed(client: Client, session: Path) -> Heard:
    """Connect with a session that is written down, and follow the state of the pump."""
    client.session_timeout = SESSION_MS
    client.session_state_path = session
    await client.connect()
    heard = Heard()
    subscription = await client.create_subscription(PUBLISHING_MS, heard)
    await subscription.subscribe_data_change(node(client, f"{PUMP}/State"))
    await heard.until("healthy")
    return heard


async def told_of(client: Client) -> list[str]:
    """Ask as the session does that the client took up again, until a state is told."""
    while True:
        response = await client.uaclient.publish([])
        for told in response.Parameters.NotificationMessage.NotificationData:
            if isinstance(told, ua.DataChangeNotification):
                return [item.Value.Value.Value for item in told.MonitoredItems]


async def away(settings: Settings, proxy: Proxy, repository: Repository, folder: Path) -> list[str]:
    """Vanish, have the state change, come back to the same session."""
    (link,) = proxy.links.values()
    through = f"opc.tcp://{link.seen.host}:{link.seen.port}/"
    gone = Client(through)
    await subscribed(gone, folder / "gone.json")
    kept = (folder / "gone.json").read_bytes()
    async with Client(address_of(settings)) as other:
        other_heard = Heard()
        subscription = await other.create_subscription(PUBLISHING_MS, other_heard)
        await subscription.subscribe_data_change(node(other, f"{PUMP}/State"))
        await other_heard.until("healthy")
        proxy.refuse("server", on=True)
        while link.connections:
            await asyncio.sleep(0.05)
        await asyncio.to_thread(tell, repository, FAULT)
        await other_heard.until("fault")
    proxy.refuse("server", on=False)
    (folder / "back.json").write_bytes(kept)
    back = Client(through)
    back.session_state_path = folder / "back.json"
    async with back:
        return await told_of(back)


def test_what_changed_while_a_client_was_away_waits_for_it(repository: Repository, tmp_path: Path) -> None:
    tell(repository, HEALTHY)
    settings = settings_of("opcua", tmp_path, anonymous=True, unencrypted=True)
    own, seen = (Address(LOOPBACK, port) for port in (port_of(settings), free_port()))
    with running_gateways(settings), Proxy({"server": (own, seen)}) as proxy:
        assert eventually(lambda: value(settings, f"{PUMP}/State").Value.Value == "healthy")
        told = asyncio.run(asyncio.wait_for(away(settings, proxy, repository, tmp_path), WAITS_S))
    assert told == ["fault"]
