"""The Modbus server: it reads registers out, for a bounded number of clients, and lets nobody write."""

import asyncio
from collections.abc import Callable, Mapping, Sequence
from ipaddress import ip_address

from pymodbus.constants import ExcCodes
from pymodbus.datastore import ModbusServerContext
from pymodbus.pdu import DecodePDU, ExceptionResponse, ModbusPDU
from pymodbus.server import ModbusTcpServer
from pymodbus.server.requesthandler import ServerRequestHandler
from pymodbus.simulator import DataType, SimData, SimDevice

from service.configuration.gateways.modbus import ModbusSettings
from service.gateways.modbus.register_map import FIRST_BLOCK, MOST_MOTORS, NOTHING_KNOWN, REGISTERS

READ = (3, 4)
"""Functions that read holding and input registers. Both see the same ones."""


class Registers:
    """What the server reads out: of no motor anything is known before it is put."""

    def __init__(self) -> None:
        self._values = [*[0] * FIRST_BLOCK, *NOTHING_KNOWN * MOST_MOTORS]

    def device(self) -> SimDevice:
        """Return the device that answers for every unit identifier."""
        data = SimData(0, values=[0] * REGISTERS, datatype=DataType.REGISTERS)
        return SimDevice(id=0, simdata=[data], action=self._read)

    def put(self, blocks: Mapping[int, Sequence[int]]) -> None:
        """Replace the registers from each of these addresses on."""
        for address, values in blocks.items():
            self._values[address : address + len(values)] = values

    async def _read(
        self,
        _function: int,
        first: int,
        address: int,
        count: int,
        registers: list[int],
        _written: list[int] | list[bool] | None,
    ) -> ExcCodes | None:
        """Let the library answer with what is known now."""
        registers[address - first : address - first + count] = self._values[address : address + count]
        return None


class BoundedServer(ModbusTcpServer):
    """Closes connections of clients that are not allowed, beyond the most, and that say nothing for long."""

    def __init__(self, device: SimDevice, settings: ModbusSettings) -> None:
        super().__init__(device, address=(str(settings.bind_address), settings.port))
        self.decoder = _ReadingOnly(True)  # noqa: FBT003 - the library's own way to say "requests"
        self._settings = settings

    def callback_new_connection(self) -> ServerRequestHandler:
        """Return what answers a new connection."""
        return _Connection(self, self._settings, lambda: len(self.active_connections))


class _ReadingOnly(DecodePDU):
    """Decodes requests to read, and lets all else be refused before the library makes anything of it.

    The library has answers of its own to diagnostics, files and queues, which are made up.
    """

    def decode(self, frame: bytes) -> ModbusPDU:
        function = frame[0]
        if function not in READ:
            return _Refused(function, ExcCodes.ILLEGAL_FUNCTION)
        return super().decode(frame) or _Refused(function, ExcCodes.ILLEGAL_VALUE)


class _Refused(ModbusPDU):
    """A request whose answer is an exception."""

    def __init__(self, function: int, reason: ExcCodes) -> None:
        super().__init__()
        self.function_code = function
        self._reason = reason

    async def datastore_update(self, _context: ModbusServerContext, _device_id: int) -> ModbusPDU:
        """Return the exception; nothing is looked up."""
        return ExceptionResponse(self.function_code, self._reason)


class _Connection(ServerRequestHandler):
    def __init__(
        self, server: ModbusTcpServer, settings: ModbusSettings, connections: Callable[[], int]
    ) -> None:
        super().__init__(server, None, None, None)  # type: ignore[no-untyped-call]
        self._settings = settings
        self._connections = connections
        self._idle: asyncio.TimerHandle | None = None

    def callback_connected(self) -> None:
        """Close the connection at once where it is one too many, or not allowed."""
        super().callback_connected()
        if self._connections() > self._settings.max_connections or not self._is_allowed():
            self.loop.call_soon(self.close)
        else:
            self._wait()

    def callback_data(self, data: bytes, addr: tuple[str, int] | None = None) -> int:
        """Take what has come, and wait anew."""
        self._wait()
        return super().callback_data(data, addr)

    def callback_disconnected(self, exc: Exception | None) -> None:
        """Forget the wait."""
        if self._idle is not None:
            self._idle.cancel()
        super().callback_disconnected(exc)

    def _wait(self) -> None:
        if self._idle is not None:
            self._idle.cancel()
        self._idle = self.loop.call_later(self._settings.idle_timeout_s, self.close)

    def _is_allowed(self) -> bool:
        peer = None if self.transport is None else self.transport.get_extra_info("peername")
        return peer is not None and self._settings.allows(ip_address(peer[0].partition("%")[0]))
