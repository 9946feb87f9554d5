"""ISO transport over TCP (RFC 1006, ISO 8073 class 0): messages out of data units, and into them again."""

from asyncio import StreamReader
from dataclasses import dataclass

DATA, CONNECT_CONFIRM = 0xF0, 0xD0
_TPKT_HEADER = 4
_DATA_HEADER = 3
_SIZE_PARAMETER = 0xC0
_LARGEST = 8192


@dataclass(frozen=True, slots=True)
class Message:
    """One transport service data unit.

    `kind` is DATA, or the kind of a connection's other units. `units` holds the units as they came, with
    their headers, and `user_data` what the DATA units carry, in one piece.
    """

    kind: int
    units: tuple[bytes, ...]
    user_data: bytes = b""


async def read_message(reader: StreamReader) -> Message:
    """Read the next message. Raise asyncio.IncompleteReadError at the connection's end."""
    units: list[bytes] = []
    user_data: list[bytes] = []
    while True:
        header = await reader.readexactly(_TPKT_HEADER)
        unit = header + await reader.readexactly(max(0, int.from_bytes(header[2:], "big") - _TPKT_HEADER))
        units.append(unit)
        kind = unit[5] & 0xF0 if len(unit) > 5 else 0
        if kind != DATA:
            return Message(kind, tuple(units))
        user_data.append(unit[_TPKT_HEADER + _DATA_HEADER :])
        if unit[6] & 0x80:
            return Message(DATA, tuple(units), b"".join(user_data))


def unit_size(confirm: Message) -> int:
    """Return the largest data unit that a connect confirm agrees to [octet]."""
    unit = confirm.units[0]
    place = _TPKT_HEADER + 7
    while place + 2 <= len(unit):
        if unit[place] == _SIZE_PARAMETER:
            return min(int(2 ** unit[place + 2]), _LARGEST)
        place += 2 + unit[place + 1]
    return 128


def units_of(user_data: bytes, size: int) -> bytes:
    """Divide a message into data units of at most `size` octets, with their headers."""
    most = size - _DATA_HEADER
    parts = [user_data[k : k + most] for k in range(0, len(user_data), most)] or [b""]
    units = []
    for part in parts:
        last = 0x80 if part is parts[-1] else 0
        length = _TPKT_HEADER + _DATA_HEADER + len(part)
        units.append(bytes([3, 0]) + length.to_bytes(2, "big") + bytes([2, DATA, last]) + part)
    return b"".join(units)
