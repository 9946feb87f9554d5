"""The Modbus server: it reads registers out, for a bounded number of clients, and lets nobody write."""

from collections.abc import Mapping, Sequence
from typing import Final

from pymodbus.constants import ExcCodes
from pymodbus.datastore import ModbusServerContext
from pymodbus.pdu import DecodePDU, ExceptionResponse, ModbusPDU
from pymodbus.server import ModbusTcpServer
from pymodbus.simulator import DataType, SimData, SimDevice

from service.configuration.gateways.modbus import ModbusSettings
from service.gateways.modbus.connection import Connection
from service.gateways.modbus.register_map import FIRST_BLOCK, MOST_MOTORS, NOTHING_KNOWN, REGISTERS

READ = (3, 4)
"""Functions that read holding and input registers. Both see the same ones."""

SILENT_S: Final = 5.0
"""Where all places are taken, a client that asked no longer ago keeps its own."""


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
    """Has places for some clients: who asks keeps one, who asks nothing gives way to others."""

    def __init__(self, device: SimDevice, settings: ModbusSettings) -> None:
        super().__init__(device, address=(str(settings.bind_address), settings.port))
        self.decoder = _ReadingOnly(True)  # noqa: FBT003 - the library's own way to say "requests"
        self._settings = settings
        self._connections: set[Connection] = set()

    def callback_new_connection(self) -> Connection:
        """Return what answers a new connection."""
        return Connection(self, self._settings, on_open=self._opened, on_close=self._connections.discard)

    def _opened(self, new: Connection) -> bool:
        """Tell whether there is a place for a connection. The one without a request for longest gives way.

        Those that never sent a whole one do so first, however new they are.
        """
        if len(self._connections) >= self._settings.max_connections:
            before_s = self.loop.time() - SILENT_S
            idle = [one for one in self._connections if not one.has_asked or one.waiting_since_s < before_s]
            if not idle:
                return False
            min(idle, key=lambda one: (one.has_asked, one.waiting_since_s)).end()
        self._connections.add(new)
        return True


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
