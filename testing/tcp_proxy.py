"""The network between clients and their servers: a TCP proxy that cuts, freezes and refuses on demand."""

import asyncio
import socket
import struct
import threading
from collections.abc import Mapping
from contextlib import suppress
from types import TracebackType
from typing import Self

from scl import Address

CHUNK_BYTES = 65_536
_CLOSING_PERIOD_S = 0.05
RESET = struct.pack("ii", 1, 0)
"""SO_LINGER on, for no time: closing resets the connection."""


class Link:
    """The way to one server. Used by the proxy's own thread, but for the counter."""

    def __init__(self, own: Address, seen: Address) -> None:
        self.own = own
        self.seen = seen
        self.carried_bytes = 0
        self.accepted = 0
        self.refuses = False
        self.cut_after_bytes: int | None = None
        self.flowing = asyncio.Event()
        self.flowing.set()
        self._writers: set[asyncio.StreamWriter] = set()
        self._server: asyncio.Server | None = None

    @property
    def connections(self) -> int:
        """Number of connections that stand."""
        return len(self._writers) // 2

    async def listen(self) -> None:
        self._server = await asyncio.start_server(self._accept, self.seen.host, self.seen.port)

    def cut(self) -> None:
        """Reset every connection."""
        for writer in list(self._writers):
            _reset(writer)

    def end(self) -> None:
        """Reset every connection, and from now on each that comes."""
        self.refuses = True
        self.flowing.set()
        self.cut()

    def stop_listening(self) -> None:
        """Accept no connection any more."""
        if self._server is not None:
            self._server.close()

    async def _accept(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.accepted += 1
        if self.refuses:
            _reset(writer)
            return
        try:
            far_reader, far_writer = await asyncio.open_connection(self.own.host, self.own.port)
        except OSError:  # the server is off
            _reset(writer)
            return
        both = {writer, far_writer}
        self._writers |= both
        try:
            ways = [
                asyncio.create_task(self._carry(reader, far_writer, to_client=False)),
                asyncio.create_task(self._carry(far_reader, writer, to_client=True)),
            ]
            await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
            for way in ways:
                way.cancel()
            await asyncio.gather(*ways, return_exceptions=True)
        finally:
            self._writers -= both
            for each in both:
                _reset(each)

    async def _carry(
        self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, *, to_client: bool
    ) -> None:
        """Until one of the two ends, however it ends."""
        with suppress(OSError):
            while chunk := await reader.read(CHUNK_BYTES):
                await self.flowing.wait()
                if to_client:
                    self.carried_bytes += len(chunk)
                    if self._is_over(len(chunk)):
                        writer.write(chunk[: len(chunk) // 2])
                        await writer.drain()
                        self.cut()
                        return
                writer.write(chunk)
                await writer.drain()

    def _is_over(self, size: int) -> bool:
        """Whether the cut that was asked for falls into this chunk; then it is done with."""
        if self.cut_after_bytes is None:
            return False
        self.cut_after_bytes -= size
        if self.cut_after_bytes > 0:
            return False
        self.cut_after_bytes = None
        return True


class Proxy:
    """The links to all servers, in a thread of their own while the context is entered."""

    def __init__(self, ways: Mapping[str, tuple[Address, Address]]) -> None:
        """`ways`: own address of each server, and the one at which its clients see it."""
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="proxy")
        self.links = {name: Link(own, seen) for name, (own, seen) in ways.items()}

    @property
    def carried_bytes(self) -> int:
        """From all servers to their clients."""
        return sum(link.carried_bytes for link in self.links.values())

    def cut(self, name: str) -> None:
        self._loop.call_soon_threadsafe(self.links[name].cut)

    def cut_after(self, name: str, size: int) -> None:
        """Cut once the server has sent so much more."""
        self._loop.call_soon_threadsafe(setattr, self.links[name], "cut_after_bytes", size)

    def refuse(self, name: str, *, on: bool) -> None:
        """Turn away new connections; what is connected is cut."""
        link = self.links[name]
        self._loop.call_soon_threadsafe(setattr, link, "refuses", on)
        if on:
            self.cut(name)

    def freeze(self, name: str, *, on: bool) -> None:
        """Carry nothing, and lose nothing: what was sent arrives when it thaws."""
        flowing = self.links[name].flowing
        self._loop.call_soon_threadsafe(flowing.clear if on else flowing.set)

    def __enter__(self) -> Self:
        self._thread.start()
        for link in self.links.values():
            asyncio.run_coroutine_threadsafe(link.listen(), self._loop).result(10)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        asyncio.run_coroutine_threadsafe(self._close(), self._loop).result(30)
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    async def _close(self) -> None:
        """End every link, and stop listening at a moment in which nothing is being accepted.

        asyncio loses a connection whose server is closed while it is being accepted, and prints a traceback
        of one whose task is cancelled.
        """
        while True:
            for link in self.links.values():
                link.end()
            others = asyncio.all_tasks() - {asyncio.current_task()}
            if not others:
                break
            await asyncio.wait(others, timeout=_CLOSING_PERIOD_S)
        for link in self.links.values():
            link.stop_listening()
        await asyncio.sleep(0)  # connections that were reset are closed in the loop's next round


def _reset(writer: asyncio.StreamWriter) -> None:
    connection = writer.get_extra_info("socket")
    if connection is not None and connection.fileno() >= 0:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, RESET)
    writer.transport.abort()
