"""Values of a data set as GOOSE carries them (IEC 61850-8-1 annex A, Data)."""

import struct
from collections.abc import Sequence

from mms.goose.ber import element, elements, integer
from mms.goose.errors import GooseFrameError
from mms.values import BitString, DataAccessError, Timestamp, Value

ARRAY, STRUCTURE, BOOLEAN, BIT_STRING, INTEGER, UNSIGNED = 0xA1, 0xA2, 0x83, 0x84, 0x85, 0x86
FLOAT, OCTET_STRING, VISIBLE_STRING, BINARY_TIME, MMS_STRING, UTC_TIME = 0x87, 0x89, 0x8A, 0x8C, 0x90, 0x91

DEEPEST = 16
"""Structures within structures: the deepest common data class has five."""

_PLACE = "allData"
_FLOATS = {5: (8, ">f"), 9: (11, ">d")}
"""Size of the element: bits of the exponent, which is its first octet, and format of the rest."""
_LONGEST_INTEGER = 9


def encode_values(values: Sequence[Value]) -> bytes:
    """Encode values one after the other.

    Parameters
    ----------
    values : sequence of Value
        The values. A float becomes one of 32 bits, an int an INT, bytes an octet string.

    Returns
    -------
    bytes
        The elements.

    Raises
    ------
    ValueError
        GOOSE carries no such value.
    """
    return b"".join(_encoded(value) for value in values)


def decode_values(octets: bytes) -> tuple[Value, ...]:
    """Decode values.

    Parameters
    ----------
    octets : bytes
        Elements, one after the other.

    Returns
    -------
    tuple of Value
        The values. Binary times, which GOOSE hardly ever carries, come as their octets.

    Raises
    ------
    GooseFrameError
        They are no values.
    """
    return _decoded_all(octets, 0)


def _encoded(value: Value) -> bytes:
    match value:
        case bool():
            return element(BOOLEAN, bytes([value]))
        case int():
            return element(INTEGER, integer(value))
        case float():
            return element(FLOAT, bytes([8]) + struct.pack(">f", value))
        case str():
            return element(MMS_STRING if not value.isascii() else VISIBLE_STRING, value.encode())
        case bytes():
            return element(OCTET_STRING, value)
        case Timestamp():
            return element(UTC_TIME, value.octets())
        case BitString():
            return element(BIT_STRING, _bits(value))
        case tuple():
            return element(STRUCTURE, encode_values(value))
        case None | DataAccessError():
            raise ValueError(f"GOOSE carries no {value!r}")


def _bits(value: BitString) -> bytes:
    unused = -len(value.bits) % 8
    padded = (*value.bits, *(False,) * unused)
    octets = bytes(
        sum(bit << (7 - place) for place, bit in enumerate(padded[begin : begin + 8]))
        for begin in range(0, len(padded), 8)
    )
    return bytes([unused]) + octets


def _decoded_all(octets: bytes, depth: int) -> tuple[Value, ...]:
    if depth > DEEPEST:
        raise GooseFrameError(_PLACE, f"structures at most {DEEPEST} deep", "deeper ones")
    return tuple(_decoded(tag, content, depth) for tag, content in elements(octets, _PLACE))


def _decoded(tag: int, content: bytes, depth: int) -> Value:
    size = len(content)
    match tag:
        case 0xA1 | 0xA2:  # ARRAY, STRUCTURE
            return _decoded_all(content, depth + 1)
        case 0x83 if size == 1:  # BOOLEAN
            return content != b"\x00"
        case 0x84 if size and content[0] < 8 and (size > 1 or not content[0]):  # BIT_STRING
            bits = [bool(octet >> (7 - place) & 1) for octet in content[1:] for place in range(8)]
            return BitString(tuple(bits[: len(bits) - content[0]]))
        case 0x85 | 0x86 if 0 < size <= _LONGEST_INTEGER:  # INTEGER, UNSIGNED
            return int.from_bytes(content, "big", signed=tag == INTEGER)
        case 0x87 if size in _FLOATS and content[0] == _FLOATS[size][0]:  # FLOAT
            (number,) = struct.unpack(_FLOATS[size][1], content[1:])
            return float(number)
        case 0x89 | 0x8C:  # OCTET_STRING, BINARY_TIME
            return content
        case 0x8A | 0x90:  # VISIBLE_STRING, MMS_STRING
            return content.decode("utf-8", errors="replace")
        case 0x91 if size == 8:  # UTC_TIME
            return Timestamp.of(content)
    raise GooseFrameError(_PLACE, "a value of a data set", f"tag 0x{tag:02x} with {size} octets")
