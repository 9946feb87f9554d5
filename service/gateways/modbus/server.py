"""The Modbus server: it reads registers out, for a bounded number of clients, and lets nobody write."""

import asyncio
from collections.abc import Callable, Mapping, Sequence
from ipaddress import ip_address

from pymodbus.constants import ExcCodes
from pymodbus.server import ModbusTcpServer
from pymodbus.server.requesthandler import ServerRequestHandler
from pymodbus.simulator import DataType, SimData, SimDevice

from service.configuration.gateways.modbus import ModbusSettings
from service.gateways.modbus.register_map import REGISTERS

READ = (3, 4)
"""Functions that read holding and input registers. Both see the same ones."""


class Registers:
    """What the server reads out."""

    def __init__(self) -> None:
        self._values = [0] * REGISTERS

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
        function: int,
        first: int,
        address: int,
        count: int,
        registers: list[int],
        written: list[int] | list[bool] | None,
    ) -> ExcCodes | None:
        """Let the library answer with what is known now. Refuses everything but reading."""
        if function not in READ or written is not None:
            return ExcCodes.ILLEGAL_FUNCTION
        registers[address - first : address - first + count] = self._values[address : address + count]
        return None


class BoundedServer(ModbusTcpServer):
    """Closes connections of clients that are not allowed, beyond the most, and that say nothing for long."""

    def __init__(self, device: SimDevice, settings: ModbusSettings) -> None:
        super().__init__(device, address=(str(settings.bind_address), settings.port))
        self._settings = settings

    def callback_new_connection(self) -> ServerRequestHandler:
        """Return what answers a new connection."""
        return _Connection(self, self._settings, lambda: len(self.active_connections))


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
