"""The router of the demo enterprise, between the network of a factory and the wide-area network.

It forwards TCP connections. It listens at every address at which, by the SCD, a relay of the factory is
reached from outside, and passes each connection on to the relay's address inside. So it needs no privileges
and no route on any other host, and the relays have no way out of their network.

`python -m service.demo.router --scd FILE --inside FACTORY_A --outside WAN`
"""

import argparse
import asyncio
import signal
import socket
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import structlog

import scl
from scl import Address, SclError
from service.process.logs import configure_logging

log = structlog.get_logger(__name__)

CONNECT_TIMEOUT_S = 3.0
"""Shorter than the service's own, so that the service sees a closed connection before its time runs out."""

MOST_CONNECTIONS = 8
"""To one relay at a time. Relays allow about as many associations, and it limits the router's memory."""

CHUNK_BYTES = 65536

EVERY_INTERFACE = "0.0.0.0"  # noqa: S104 - a router's name may resolve to its address on either network

KEEP_ALIVE = {socket.TCP_KEEPIDLE: 10, socket.TCP_KEEPINTVL: 5, socket.TCP_KEEPCNT: 3}
"""Times [s] and probes. A relay allows few associations, so dead connections must end soon."""


@dataclass(frozen=True, slots=True)
class Passage:
    """Forwards connections from a port of the router to a relay."""

    relay: str
    port: int
    address: Address
    _places: asyncio.Semaphore = field(
        default_factory=lambda: asyncio.Semaphore(MOST_CONNECTIONS), repr=False, compare=False
    )

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Forward one connection until either side ends it; refuse it when MOST_CONNECTIONS are open."""
        if self._places.locked():
            client, *_ = writer.get_extra_info("peername") or ("gone",)
            reason = f"{MOST_CONNECTIONS} connections are open"
            log.warning("connection refused", relay=self.relay, client=client, reason=reason)
            writer.transport.abort()
            return
        async with self._places:
            await self._pass_on(reader, writer)

    async def _pass_on(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            async with asyncio.timeout(CONNECT_TIMEOUT_S):
                relay_reader, relay_writer = await asyncio.open_connection(
                    self.address.host, self.address.port
                )
        except OSError as error:  # a timeout is one
            reason = str(error) or f"no answer within {CONNECT_TIMEOUT_S:g} s"
            log.warning("relay unreachable", relay=self.relay, address=str(self.address), reason=reason)
            writer.transport.abort()
            return
        try:
            for end in (writer, relay_writer):
                _keep_alive(end)
            async with asyncio.TaskGroup() as both_ways:
                both_ways.create_task(_copy(reader, relay_writer))
                both_ways.create_task(_copy(relay_reader, writer))
        except* OSError as lost:
            log.info("connection lost", relay=self.relay, reason=str(lost.exceptions[0]))
        finally:
            writer.transport.abort()
            relay_writer.transport.abort()


def passages(scd: Path, inside: str, outside: str) -> list[Passage]:
    """Return one for each relay of the subnetwork `inside`, at its port on `outside`. Raises SclError."""
    document = scl.read(scd)
    within, without = document.seen_from(inside), document.seen_from(outside)
    relays = dict.fromkeys(
        connected.ied for network in within.communication for connected in network.connected_access_points
    )
    return [Passage(name, without.address(name).port, within.address(name)) for name in relays]


async def route(ways: Sequence[Passage], stop: asyncio.Event) -> None:
    """Forward connections until `stop` is set. Raises OSError where a port cannot be opened."""
    servers = []
    for way in ways:
        servers.append(await asyncio.start_server(way.serve, EVERY_INTERFACE, way.port, limit=CHUNK_BYTES))
        log.info("listening", relay=way.relay, port=way.port, address=str(way.address))
    await stop.wait()
    for server in servers:
        server.close()


async def _copy(source: asyncio.StreamReader, sink: asyncio.StreamWriter) -> None:
    """Copy until the source ends, and close the sink then: MMS does not use half-open connections."""
    while chunk := await source.read(CHUNK_BYTES):
        sink.write(chunk)
        await sink.drain()
    sink.close()


def _keep_alive(end: asyncio.StreamWriter) -> None:
    connection: socket.socket = end.get_extra_info("socket")
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    for option, value in KEEP_ALIVE.items():
        connection.setsockopt(socket.IPPROTO_TCP, option, value)


async def _route_until_told(ways: Sequence[Passage]) -> None:
    stop = asyncio.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        asyncio.get_running_loop().add_signal_handler(number, stop.set)
    await route(ways, stop)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run until SIGTERM or SIGINT. Returns 0, or 1 with the reason on stderr."""
    parser = argparse.ArgumentParser(prog="router", description="The way to a factory's relays.")
    parser.add_argument("--scd", type=Path, required=True, help="SCD file with both networks.")
    parser.add_argument("--inside", required=True, help="The factory's SubNetwork.")
    parser.add_argument("--outside", required=True, help="The SubNetwork to listen on.")
    options = parser.parse_args(arguments)
    configure_logging("router")
    try:
        asyncio.run(_route_until_told(passages(options.scd, options.inside, options.outside)))
    except (SclError, OSError) as error:
        sys.stderr.write(f"router: {error}\n")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
