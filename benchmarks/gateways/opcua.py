"""python -m benchmarks.gateways.opcua: the OPC UA server with 500 motors, and a client subscribed to all."""

import asyncio
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Event, Thread
from typing import Any

from asyncua import Client, Node, ua

from benchmarks.gateways.load import argument_parser, measure
from benchmarks.gateways.plant import changing_plant
from service.configuration.gateways.opcua import OpcUaSettings
from service.configuration.gateways.settings import GatewaysSettings
from service.configuration.settings import Settings
from testing.ports import LOOPBACK, free_port
from testing.service.gateways import running_gateways
from testing.waiting import wait_until

MOST_AT_ONCE = 1000
"""Variables in one request."""


class Subscribed:
    """A client in a thread of its own that is told of each change."""

    def __init__(self, address: str, motors: list[str]) -> None:
        self._address, self._motors = address, motors
        self.healths: dict[str, int] = {}
        self._end = Event()
        self._thread = Thread(target=lambda: asyncio.run(self._follow()), daemon=True)
        self._thread.start()

    def datachange_notification(self, node: Any, value: int, _data: object) -> None:
        """Keep the health of a motor."""
        _, motor, *variable = str(node.nodeid.Identifier).split("/")
        if variable == ["DeviceHealth"]:
            self.healths[motor] = value

    def close(self) -> None:
        """End the connection."""
        self._end.set()
        self._thread.join(30)

    async def _follow(self) -> None:
        async with Client(self._address) as client:
            subscription = await client.create_subscription(100, self)
            first = f"motor/{self._motors[0]}/"
            below = await _variables(client.get_node(f"ns=2;s={first.rstrip('/')}"))
            names = [str(one.nodeid.Identifier).removeprefix(first) for one in below]
            nodes = [
                client.get_node(f"ns=2;s=motor/{motor}/{name}") for motor in self._motors for name in names
            ]
            for begin in range(0, len(nodes), MOST_AT_ONCE):
                await subscription.subscribe_data_change(nodes[begin : begin + MOST_AT_ONCE])
            print(f"subscribed to {len(names)} variables of each motor, {len(nodes)} in all")
            await asyncio.to_thread(self._end.wait)


async def _variables(node: Node) -> list[Node]:
    """The variables of a node, and of the objects below it, each once."""
    found = {one.nodeid: one for one in await node.get_variables()}
    for child in await node.get_children(nodeclassmask=ua.NodeClass.Object):
        found |= {one.nodeid: one for one in await _variables(child)}
    return list(found.values())


def main() -> None:
    """Print the figures."""
    wanted = argument_parser(__doc__).parse_args()
    with TemporaryDirectory(prefix="statorwatch-") as directory:
        plant = changing_plant(Path(directory), wanted.motors, now_ns=time.time_ns())
        server = OpcUaSettings(port=free_port(), anonymous=True, unencrypted=True)
        settings = Settings(data_directory=Path(directory), gateways=GatewaysSettings(opcua=server))
        begun_s = time.monotonic()
        with running_gateways(settings) as running:
            print(f"serving after {time.monotonic() - begun_s:.1f} s")
            (status,) = running.status()
            assert status.process_id is not None
            client = Subscribed(f"opc.tcp://{LOOPBACK}:{server.port}/", list(plant.motors))

            def wait_for(motor: str, *, is_faulty: bool) -> None:
                expected = 1 if is_faulty else 0
                wait_until(lambda: client.healths.get(motor) == expected, f"the health of {motor}")

            wait_for(plant.motors[-1], is_faulty=False)
            load = measure(status.process_id, plant, wait_for, idle_s=wanted.idle_s, changes=wanted.changes)
            client.close()
    print(f"{wanted.motors} motors: {load}")


if __name__ == "__main__":
    main()
