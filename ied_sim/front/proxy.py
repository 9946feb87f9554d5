"""The TCP side of the proxies: connections accepted in a relay's place and passed on to its server."""

import asyncio
import logging
import threading
from asyncio import StreamReader, StreamWriter
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field

from ied_sim.front.reserved_address import ReservedAddress
from ied_sim.front.rewriting import Rewriter
from ied_sim.front.transport import CONNECT_CONFIRM, DATA, Message, read_message, unit_size, units_of
from ied_sim.misbehaviour import Kind, MisbehaviourState
from ied_sim.profiles.profile import Files
from mms import MOST_CONNECTIONS
from scl import Address

log = logging.getLogger(__name__)

_FROZEN_POLL_S = 0.02

OpenOverflowServer = Callable[[], Address | None]
"""Opens a second server beside the first where there is none yet; returns None while the relay is down."""


@dataclass(slots=True)
class _Session:
    """One client's connection and the one to the server behind it."""

    client: StreamWriter
    server: StreamWriter
    rewriter: Rewriter
    unit_size: int = 1024
    file_bytes: int = field(default=0)


class RelayProxy:
    """Proxy of one relay: accepts clients at `outside` and passes their requests to the server at `inside`.

    At most `sessions` clients are served at once. Those beyond MOST_CONNECTIONS are passed to the overflow
    server. The loop of RelayProxies runs the proxy.
    """

    def __init__(
        self,
        outside: Address,
        inside: Address,
        files: Files | None,
        misbehaviour_state: MisbehaviourState,
        report_ids: Mapping[str, str],
        *,
        sessions: int,
        overflow_server: OpenOverflowServer,
    ) -> None:
        self.passed_on: Callable[[], None] = _tell_nobody
        """Called after something was sent to the server."""
        self.outside = outside
        self._inside = inside
        self._most = sessions
        self._overflow_server = overflow_server
        self._opening = asyncio.Lock()
        self._files = files
        self._misbehaviour_state = misbehaviour_state
        self._report_ids = report_ids
        self._sessions = self._in_overflow = 0
        self._tasks: set[asyncio.Task[None]] = set()
        self._listening: asyncio.Server | None = None

    async def open(self) -> None:
        """Listen. Raise OSError where the address cannot be had."""
        self._listening = await asyncio.start_server(self._accept, self.outside.host, self.outside.port)

    async def close(self) -> None:
        """End all sessions."""
        if self._listening is not None:
            self._listening.close()
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    async def _accept(self, reader: StreamReader, writer: StreamWriter) -> None:
        task = asyncio.current_task()
        assert task is not None  # noqa: S101 - asyncio calls this in one
        self._tasks.add(task)
        few = self._misbehaviour_state.number(Kind.FEW_SESSIONS)
        try:
            if self._sessions < (self._most if few is None else min(few, self._most)):
                self._sessions += 1
                try:
                    await self._serve(reader, writer)
                finally:
                    self._sessions -= 1
        except asyncio.CancelledError:
            log.debug("a session ends with the simulator")
        finally:
            writer.close()
            self._tasks.discard(task)

    async def _serve(self, reader: StreamReader, writer: StreamWriter) -> None:
        """Serve a client from the server while that has a session left, else from the overflow server."""
        if self._sessions - self._in_overflow <= MOST_CONNECTIONS:
            await self._serve_at(self._inside, reader, writer)
            return
        self._in_overflow += 1
        try:
            async with self._opening:
                address = await asyncio.to_thread(self._overflow_server)
            if address is not None:
                await self._serve_at(address, reader, writer)
        finally:
            self._in_overflow -= 1

    async def _serve_at(self, address: Address, reader: StreamReader, writer: StreamWriter) -> None:
        try:
            from_server, to_server = await asyncio.open_connection(address.host, address.port)
        except OSError:
            return
        self.passed_on()
        session = _Session(
            writer, to_server, Rewriter(self._files, self._misbehaviour_state, self._report_ids)
        )
        both = (self._requests(reader, session), self._responses(from_server, session))
        tasks = [asyncio.ensure_future(each) for each in both]
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
            to_server.close()
            self.passed_on()

    async def _requests(self, reader: StreamReader, session: _Session) -> None:
        with suppress(asyncio.IncompleteReadError, ConnectionError):
            while True:
                message = await read_message(reader)
                await self._wait_while_frozen()
                refusal = session.rewriter.refusal(message.user_data)
                if refusal is not None:
                    session.client.write(units_of(refusal, session.unit_size))
                    await session.client.drain()
                    continue
                if message.kind == DATA:
                    rewritten = session.rewriter.request(message.user_data)
                    session.server.write(_units(message, rewritten, session.unit_size))
                else:
                    session.server.write(b"".join(message.units))
                await session.server.drain()
                self.passed_on()

    async def _responses(self, reader: StreamReader, session: _Session) -> None:
        with suppress(asyncio.IncompleteReadError, ConnectionError):
            while True:
                message = await read_message(reader)
                delay_s = self._misbehaviour_state.number(Kind.SLOW_REPLIES)
                if delay_s is not None:
                    await asyncio.sleep(delay_s)
                await self._wait_while_frozen()
                if not self._pass_on(message, session):
                    return
                await session.client.drain()

    def _pass_on(self, message: Message, session: _Session) -> bool:
        """Write a server's message to the client; return False where the connection is cut instead."""
        if message.kind == CONNECT_CONFIRM:
            session.unit_size = unit_size(message)
        if message.kind != DATA:
            session.client.write(b"".join(message.units))
            return True
        rewritten = session.rewriter.response(message.user_data)
        session.file_bytes += rewritten.file_bytes
        most = self._misbehaviour_state.number(Kind.CUT_MID_FILE)
        if most is None:
            session.file_bytes = 0
        elif rewritten.file_bytes and session.file_bytes > most:
            session.client.transport.abort()
            return False
        session.client.write(_units(message, rewritten.user_data, session.unit_size))
        return True

    async def _wait_while_frozen(self) -> None:
        """Wait while the relay is frozen."""
        while self._misbehaviour_state.is_on(Kind.FROZEN):
            await asyncio.sleep(_FROZEN_POLL_S)


def _units(message: Message, user_data: bytes, size: int) -> bytes:
    """Return the data units to send: those that came where nothing was changed."""
    return b"".join(message.units) if user_data == message.user_data else units_of(user_data, size)


def _tell_nobody() -> None:
    """Leave it at having sent something."""


class RelayProxies:
    """All proxies of a simulator, on one thread. Without proxies there is no thread."""

    def __init__(self) -> None:
        self._proxies: list[RelayProxy] = []
        self._reserved: dict[Address, ReservedAddress] = {}
        """Where the servers listen, by the address of their proxy."""
        self._running: tuple[asyncio.AbstractEventLoop, threading.Thread] | None = None

    def add(
        self,
        outside: Address,
        files: Files | None,
        misbehaviour_state: MisbehaviourState,
        report_ids: Mapping[str, str],
        *,
        sessions: int,
        overflow_server: OpenOverflowServer,
    ) -> Address:
        """Add a proxy at `outside`; return the address where the server behind it is to listen."""
        inside = ReservedAddress()
        self._reserved[outside] = inside
        self._proxies.append(
            RelayProxy(
                outside,
                inside.address,
                files,
                misbehaviour_state,
                report_ids,
                sessions=sessions,
                overflow_server=overflow_server,
            )
        )
        return inside.address

    def remove(self, outside: Address) -> None:
        """Take back the proxy at `outside`, where there is one, before the proxies are started."""
        self._proxies = [proxy for proxy in self._proxies if proxy.outside != outside]
        inside = self._reserved.pop(outside, None)
        if inside is not None:
            inside.release()

    def start(self, passed_on: Mapping[Address, Callable[[], None]]) -> Address | None:
        """Open all proxies; return None, or the address of the first that cannot be had.

        passed_on: what is called after something was sent to a server, by the server's address.
        """
        if not self._proxies:
            return None
        for proxy in self._proxies:
            proxy.passed_on = passed_on.get(self._reserved[proxy.outside].address, _tell_nobody)
        loop = asyncio.new_event_loop()
        thread = threading.Thread(target=loop.run_forever, name="front", daemon=True)
        self._running = (loop, thread)
        thread.start()
        for proxy in self._proxies:
            try:
                asyncio.run_coroutine_threadsafe(proxy.open(), loop).result()
            except OSError:
                return proxy.outside
        return None

    def stop(self) -> None:
        """Close all proxies. Without any, this does nothing."""
        for inside in self._reserved.values():
            inside.release()
        if self._running is None:
            return
        loop, thread = self._running
        self._running = None
        for proxy in self._proxies:
            asyncio.run_coroutine_threadsafe(proxy.close(), loop).result()
        loop.call_soon_threadsafe(loop.stop)
        thread.join()
        loop.close()
