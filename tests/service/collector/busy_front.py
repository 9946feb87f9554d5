"""Stands between a session and a real relay, and answers chosen requests with a ServiceError in its place."""

import asyncio
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass, field

from ied_sim.front.transport import read_message
from testing.ports import LOOPBACK
from tests.hostile.background import background_loop
from tests.hostile.dialogue import CONFIRMED_REQUEST, framed, message, pdu_of, tlv

LIST_OF_NAMES, READ, WRITE, VARIABLE_DESCRIPTION, DATA_SET_MEMBERS, FILE_DIRECTORY = (
    *(b"\xa1", b"\xa4", b"\xa5", b"\xa6", b"\xac"),
    b"\xbf\x4d",
)
CONFIRMED_ERROR = 0xA2
RESOURCE_OTHER = (0x83, 0)
"""Error class and code of ISO 9506-2, ServiceError: resource, other."""


@dataclass
class BusyFront:
    """A front of the relay at `target`.

    refused: services that are answered by `error`, by their tags, and how many times; asked: requests seen.
    """

    target: int
    refused: dict[bytes, int] = field(default_factory=dict)
    error: tuple[int, int] = RESOURCE_OTHER
    asked: list[bytes] = field(default_factory=list)
    port: int = 0

    async def serve(self, client: asyncio.StreamReader, to_client: asyncio.StreamWriter) -> None:
        with closing(to_client):
            relay, to_relay = await asyncio.open_connection(LOOPBACK, self.target)
            await asyncio.gather(self._requests(client, to_client, to_relay), self._pass(relay, to_client))

    async def _requests(
        self, client: asyncio.StreamReader, to_client: asyncio.StreamWriter, to_relay: asyncio.StreamWriter
    ) -> None:
        try:
            with suppress(asyncio.IncompleteReadError, ConnectionError):
                while True:
                    passing = await read_message(client)
                    pdu = pdu_of(passing.user_data)
                    if pdu is not None and pdu.tag == CONFIRMED_REQUEST and pdu.parts:
                        tag = pdu.parts[-1].tag
                        self.asked.append(tag)
                        if self.refused.get(tag, 0) > 0:
                            self.refused[tag] -= 1
                            to_client.write(framed(message(self._service_error(pdu.parts[0].content))))
                            continue
                    to_relay.write(b"".join(passing.units))
                    await to_relay.drain()
        finally:
            to_relay.close()

    def _service_error(self, invoke_id: bytes) -> bytes:
        kind, code = self.error
        reason = tlv(0xA2, tlv(0xA0, bytes([kind, 1, code])))
        return tlv(CONFIRMED_ERROR, tlv(0x80, invoke_id) + reason)

    async def _pass(self, source: asyncio.StreamReader, sink: asyncio.StreamWriter) -> None:
        try:
            with suppress(asyncio.IncompleteReadError, ConnectionError):
                while True:
                    sink.write(b"".join((await read_message(source)).units))
                    await sink.drain()
        finally:
            sink.close()


@contextmanager
def busy_front(target: int, refused: dict[bytes, int]) -> Iterator[BusyFront]:
    """A front on a port of its own, served on a thread of its own."""
    front = BusyFront(target, refused)
    with background_loop() as loop:
        starting = asyncio.start_server(front.serve, LOOPBACK, 0)
        server = asyncio.run_coroutine_threadsafe(starting, loop).result(10)
        front.port = int(server.sockets[0].getsockname()[1])
        try:
            yield front
        finally:
            loop.call_soon_threadsafe(server.close)
