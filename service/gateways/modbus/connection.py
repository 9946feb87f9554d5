"""A client's connection: each whole request is answered, in the order in which they come.

The library keeps one request of a connection at a time, and loses what comes close behind it.
"""

import asyncio
import struct
from collections.abc import Callable
from ipaddress import ip_address
from typing import Final

from pymodbus.pdu import ModbusPDU
from pymodbus.server import ModbusTcpServer
from pymodbus.server.requesthandler import ServerRequestHandler

from service.configuration.gateways.modbus import ModbusSettings

HEAD: Final = struct.Struct(">HHH")
"""Transaction, protocol and length of the rest: unit identifier, function and data."""
MODBUS: Final = 0
SHORTEST, LONGEST = 2, 254


class MalformedError(ValueError):
    """What has come is no request, and where the next one begins is not known."""


class Connection(ServerRequestHandler):
    """Is closed where it has no place, and where no whole request comes for long."""

    def __init__(
        self,
        server: ModbusTcpServer,
        settings: ModbusSettings,
        *,
        on_open: Callable[["Connection"], bool],
        on_close: Callable[["Connection"], None],
    ) -> None:
        super().__init__(server, None, None, None)  # type: ignore[no-untyped-call]
        self._settings = settings
        self._on_open = on_open
        self._on_close = on_close
        self._octets = bytearray()
        self._is_writable = asyncio.Event()
        self._is_writable.set()
        self._answering: asyncio.Task[None] | None = None
        self._idle: asyncio.TimerHandle | None = None
        self.has_asked = False
        self.waiting_since_s = self.loop.time()

    def callback_connected(self) -> None:
        """Close the connection at once where it has no place, or is not allowed."""
        super().callback_connected()
        if self._is_allowed() and self._on_open(self):
            self._wait()
        else:
            self.end()

    def callback_disconnected(self, exc: Exception | None) -> None:
        """Forget what was to be done."""
        self._forget()
        super().callback_disconnected(exc)

    def data_received(self, data: bytes) -> None:
        """Answer what has come; nothing more is read before that is done."""
        self._octets += data
        self._transport.pause_reading()
        self._answering = self.loop.create_task(self._answer())

    def pause_writing(self) -> None:
        """Answer no more to who takes no answers."""
        self._is_writable.clear()

    def resume_writing(self) -> None:
        """Go on."""
        self._is_writable.set()

    def end(self) -> None:
        """End the connection at once; what is still to be sent is dropped."""
        self._forget()
        if self.transport is not None:
            self._transport.abort()
        self.close()

    @property
    def _transport(self) -> asyncio.Transport:
        assert isinstance(self.transport, asyncio.Transport)  # noqa: S101 - of a TCP server
        return self.transport

    async def _answer(self) -> None:
        try:
            while (request := take_request(self._octets)) is not None:
                self.has_asked, self.waiting_since_s = True, self.loop.time()
                self._wait()
                await self._is_writable.wait()
                self.last_pdu = self._decoded(*request)
                await self.handle_request()  # type: ignore[no-untyped-call]
                await asyncio.sleep(0)  # the other connections have their turn
        except MalformedError:
            self.end()
        else:
            self._transport.resume_reading()

    def _decoded(self, transaction: int, unit: int, content: bytes) -> ModbusPDU | None:
        pdu: ModbusPDU | None = self.server.decoder.decode(content)
        if pdu is not None:
            pdu.transaction_id, pdu.dev_id = transaction, unit
        return pdu

    def _wait(self) -> None:
        if self._idle is not None:
            self._idle.cancel()
        self._idle = self.loop.call_later(self._settings.idle_timeout_s, self.end)

    def _forget(self) -> None:
        if self._idle is not None:
            self._idle.cancel()
        if self._answering is not None:
            self._answering.cancel()
        self._on_close(self)

    def _is_allowed(self) -> bool:
        peer = self._transport.get_extra_info("peername")
        return peer is not None and self._settings.allows(ip_address(peer[0].partition("%")[0]))


def take_request(buffer: bytearray) -> tuple[int, int, bytes] | None:
    """Take the first whole request off a buffer: transaction, unit, and function with its data.

    Frames of another protocol are passed over (MODBUS Messaging on TCP/IP). Raises MalformedError.
    """
    while len(buffer) >= HEAD.size:
        transaction, protocol, length = HEAD.unpack_from(buffer)
        if not SHORTEST <= length <= LONGEST:
            raise MalformedError(f"expected a length of {SHORTEST} to {LONGEST}, found {length}")
        end = HEAD.size + length
        if len(buffer) < end:
            return None
        content = bytes(buffer[HEAD.size : end])
        del buffer[:end]
        if protocol == MODBUS:
            return transaction, content[0], content[1:]
    return None
