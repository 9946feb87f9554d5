"""The hostile relay: a raw server that associates, and answers requests with something spoilt or crafted."""

import asyncio
import itertools
from collections import Counter, deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from random import Random

from ied_sim.front.ber import Element
from ied_sim.front.transport import read_message
from testing.ports import LOOPBACK
from tests.hostile import crafted, spoiling
from tests.hostile.background import background_loop
from tests.hostile.dialogue import CONFIRMED_REQUEST, Dialogue, framed, message, pdu_of, tlv

GOOD_HANDSHAKES = 0.93
GOOD_PROBES = 0.8
"""Else hardly a connection would get as far as to ask for more; a client probes by a list of names."""

LIST_OF_NAMES = b"\xa1"

MISCONDUCT = (
    *("wrong invoke id", "twice", "another service", "error", "reject", "silence", "end", "reset", "no end"),
    "one octet at a time",
)
ENDLESS_BYTES = 2_000_000
ENDLESS_UNIT = bytes([3, 0, 4, 7, 2, 0xF0, 0]) + bytes(1024)  # data that announces more, for ever
JOURNAL = 24


@dataclass
class HostileRelay:
    """`cases` counts the spoilt answers, `journal` keeps the latest in words.

    honest: share of good answers, which are no cases.
    """

    dialogue: Dialogue
    seed: int
    honest: float = 0.0
    cases: int = 0
    kinds: Counter[str] = field(default_factory=Counter)
    journal: deque[str] = field(default_factory=lambda: deque(maxlen=JOURNAL))
    port: int = 0

    def __post_init__(self) -> None:
        self._mood = Random(self.seed)

    async def start(self) -> None:
        self._server = await asyncio.start_server(self._serve, LOOPBACK, self.port)
        self.port = int(self._server.sockets[0].getsockname()[1])

    async def stop(self) -> None:
        self._server.close()

    def _case(self, peer: int, what: str, octets: bytes = b"") -> None:
        self.cases += 1
        self.kinds[what] += 1
        self.journal.append(
            f"case {self.cases} of seed {self.seed} to port {peer}: {what}: {octets[:2000].hex()}"
        )

    def _chance(self) -> Random:
        """Of the next case."""
        return Random(f"{self.seed}/{self.cases + 1}")

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            with suppress(asyncio.IncompleteReadError, ConnectionError, TimeoutError):
                await self._associate(reader, writer)
                while True:
                    asked = await read_message(reader)
                    pdu = pdu_of(asked.user_data)
                    if pdu is None or pdu.tag != CONFIRMED_REQUEST or not pdu.parts:
                        break  # a release, or an abort
                    if not await self._answer(pdu.parts[0].content, pdu.parts[-1], writer):
                        break
        finally:
            self.journal.append(f"port {_port(writer)} ended")
            writer.close()

    async def _associate(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        for step, good in enumerate(self.dialogue.handshake):
            await read_message(reader)
            chance = self._chance()
            answer = good
            if chance.random() > GOOD_HANDSHAKES:
                spoiler = chance.choice(spoiling.OF_FRAMES)
                answer = spoiler(chance, good)
                if step and chance.random() < 0.6:  # within right lengths of the frame
                    answer = framed(spoiler(chance, good[7:]))
                self._case(_port(writer), f"handshake {spoiler.__name__}", answer)
                if chance.random() < 0.1:
                    await self._without_end(writer)
            writer.write(answer)
            await writer.drain()

    async def _answer(self, invoke_id: bytes, service: Element, writer: asyncio.StreamWriter) -> bool:
        """False where nothing more can be said on this connection."""
        # Of its own, so that the case to come does not depend on how often it was put off.
        good_share = max(self.honest, GOOD_PROBES) if service.tag == LIST_OF_NAMES else self.honest
        if self._mood.random() < good_share:
            writer.write(framed(message(_response(invoke_id, self.dialogue.answer(service) or b""))))
            return True
        chance = self._chance()
        good = self.dialogue.answer(service) or b"\xbf\x48\x00"
        way = chance.random()
        lie = crafted.ANSWERS.get(service.tag)
        if lie is not None and way < 0.6:
            octets = _response(invoke_id, lie(chance))
            self._case(_port(writer), f"crafted {lie.__name__}", octets)
            writer.write(framed(message(octets)))
        elif way < 0.75:
            spoiler = chance.choice(spoiling.OF_MESSAGES)
            if chance.random() < 0.7:  # the invoke id stays, so that the answer is looked into
                octets = _response(invoke_id, spoiler(chance, good))
            else:
                octets = spoiler(chance, _response(invoke_id, good))
            self._case(_port(writer), f"message {spoiler.__name__}", octets)
            writer.write(framed(message(octets)))
        elif way < 0.83 and self.dialogue.reports:
            spoiler = chance.choice(spoiling.OF_MESSAGES)
            octets = spoiler(chance, chance.choice(self.dialogue.reports))
            self._case(_port(writer), f"report {spoiler.__name__}", octets)
            writer.write(framed(message(octets)) + framed(message(_response(invoke_id, good))))
        elif way < 0.9:
            spoiler = chance.choice(spoiling.OF_FRAMES)
            octets = message(_response(invoke_id, good))
            octets = (
                framed(spoiler(chance, octets)) if chance.random() < 0.6 else spoiler(chance, framed(octets))
            )
            self._case(_port(writer), f"frame {spoiler.__name__}", octets)
            writer.write(octets)
        else:
            return await self._misconduct(chance, invoke_id, good, writer)
        await writer.drain()
        return True

    async def _misconduct(
        self, chance: Random, invoke_id: bytes, good: bytes, writer: asyncio.StreamWriter
    ) -> bool:
        """What is no answer at all, or somebody else's."""
        kind = chance.choice(MISCONDUCT)
        self._case(_port(writer), kind)
        right = framed(message(_response(invoke_id, good)))
        if kind == "wrong invoke id":
            other = chance.choice((b"\x00", b"\xff", b"\x7f\xff\xff\xff", b"", chance.randbytes(4)))
            writer.write(framed(message(_response(other, good))))
        elif kind == "twice":
            writer.write(right * chance.choice((2, 50)))
        elif kind == "another service":
            answer = chance.choice(list(self.dialogue.answers.values()))
            writer.write(framed(message(_response(invoke_id, answer))))
        elif kind == "error":
            code = tlv(0xA2, tlv(0xA0, bytes([0x80 + chance.randrange(14), 1, chance.randrange(256)])))
            writer.write(framed(message(tlv(0xA2, tlv(0x80, invoke_id) + code))))
        elif kind == "reject":
            writer.write(framed(message(tlv(0xA4, tlv(0x80, invoke_id) + tlv(0x81, chance.randbytes(1))))))
        elif kind == "no end":
            await self._without_end(writer)
            return False
        elif kind == "one octet at a time":
            for octet in right[:60]:
                writer.write(bytes([octet]))
                await writer.drain()
            writer.write(right[60:])
        elif kind in ("end", "reset"):
            if kind == "reset":
                writer.transport.abort()
            return False
        await writer.drain()
        return True

    async def _without_end(self, writer: asyncio.StreamWriter) -> None:
        """Parts of one message, of which none is the last."""
        for _ in range(ENDLESS_BYTES // len(ENDLESS_UNIT)):
            writer.write(ENDLESS_UNIT)
            await writer.drain()


def _port(writer: asyncio.StreamWriter) -> int:
    """The client's, which tells apart whom was answered."""
    return int(writer.get_extra_info("peername")[1])


@contextmanager
def serving(relays: dict[str, HostileRelay]) -> Iterator[dict[str, HostileRelay]]:
    """The relays, served on a thread of their own."""
    with background_loop() as loop:
        for relay in relays.values():
            asyncio.run_coroutine_threadsafe(relay.start(), loop).result(10)
        yield relays
        for relay in relays.values():
            asyncio.run_coroutine_threadsafe(relay.stop(), loop).result(10)


@contextmanager
def lying(dialogue: Dialogue, lies: Mapping[bytes, Callable[[int], bytes]]) -> Iterator[int]:
    """A relay that is good but for these answers, made from their number; its port."""
    count = itertools.count()

    class Lying(Dialogue):
        def answer(self, service: Element) -> bytes | None:
            lie = lies.get(service.tag)
            return super().answer(service) if lie is None else lie(next(count))

    told = Lying(dialogue.handshake, dialogue.answers, dialogue.latest)
    with serving({"relay": HostileRelay(told, 1, honest=1.0)}) as relays:
        yield relays["relay"].port


def _response(invoke_id: bytes, service: bytes) -> bytes:
    return tlv(0xA1, tlv(0x02, invoke_id) + service)
