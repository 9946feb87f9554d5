"""Between the collector and a relay: a relay of TCP that counts requests without an answer."""

import asyncio
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass, field

from ied_sim.front.transport import read_message
from testing.ports import LOOPBACK
from tests.hostile.background import background_loop
from tests.hostile.dialogue import CONFIRMED_REQUEST, CONFIRMED_RESPONSE, pdu_of

CONFIRMED_ERROR, REJECT = b"\xa2", b"\xa4"
HELD_BACK_S = 0.002
"""Each answer, so that whoever does not wait for it shows."""


@dataclass
class Outstanding:
    """Confirmed requests (ISO 9506-2) of one client: `services` counts them by tag, `most` at one time."""

    services: Counter[bytes] = field(default_factory=Counter)
    most: int = 0
    _unanswered: set[bytes] = field(default_factory=set)

    def asked(self, user_data: bytes) -> None:
        pdu = pdu_of(user_data)
        if pdu is not None and pdu.tag == CONFIRMED_REQUEST and pdu.parts:
            self.services[pdu.parts[-1].tag] += 1
            self._unanswered.add(pdu.parts[0].content)
            self.most = max(self.most, len(self._unanswered))

    def answered(self, user_data: bytes) -> None:
        pdu = pdu_of(user_data)
        if pdu is not None and pdu.tag in (CONFIRMED_RESPONSE, CONFIRMED_ERROR, REJECT) and pdu.parts:
            self._unanswered.discard(pdu.parts[0].content)

    @contextmanager
    def before(self, relay_port: int) -> Iterator[int]:
        """Listens in the relay's place; its port."""

        async def accept(client: asyncio.StreamReader, to_client: asyncio.StreamWriter) -> None:
            with closing(to_client):
                relay, to_relay = await asyncio.open_connection(LOOPBACK, relay_port)
                await asyncio.gather(
                    _pass(client, to_relay, self.asked, 0.0),
                    _pass(relay, to_client, self.answered, HELD_BACK_S),
                )

        with background_loop() as loop:
            starting = asyncio.start_server(accept, LOOPBACK, 0)
            server = asyncio.run_coroutine_threadsafe(starting, loop).result(10)
            try:
                yield int(server.sockets[0].getsockname()[1])
            finally:
                loop.call_soon_threadsafe(server.close)


async def _pass(
    source: asyncio.StreamReader, sink: asyncio.StreamWriter, note: Callable[[bytes], None], delay_s: float
) -> None:
    try:
        with suppress(asyncio.IncompleteReadError, ConnectionError):
            while True:
                passing = await read_message(source)
                await asyncio.sleep(delay_s)
                note(passing.user_data)
                sink.write(b"".join(passing.units))
                await sink.drain()
    finally:
        sink.close()
