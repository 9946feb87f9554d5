"""Values of a data set as GOOSE carries them (IEC 61850-8-1 annex A, Data)."""

import struct
from collections.abc import Sequence
from enum import IntEnum

from mms.goose.ber import element, elements, integer
from mms.goose.errors import GooseFrameError
from mms.values import BitString, DataAccessError, Timestamp, Value


class _Tag(IntEnum):
    """Tags of Data. A match statement compares with names that have a dot."""

    BOOLEAN = 0x83
    BIT_STRING = 0x84
    INTEGER = 0x85
    UNSIGNED = 0x86
    FLOAT = 0x87
    OCTET_STRING = 0x89
    VISIBLE_STRING = 0x8A
    BINARY_TIME = 0x8C
    MMS_STRING = 0x90
    UTC_TIME = 0x91
    ARRAY = 0xA1
    STRUCTURE = 0xA2


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
            return element(_Tag.BOOLEAN, bytes([value]))
        case int():
            return element(_Tag.INTEGER, integer(value))
        case float():
            return element(_Tag.FLOAT, bytes([8]) + struct.pack(">f", value))
        case str():
            return element(_Tag.VISIBLE_STRING if _is_visible(value) else _Tag.MMS_STRING, value.encode())
        case bytes():
            return element(_Tag.OCTET_STRING, value)
        case Timestamp():
            return element(_Tag.UTC_TIME, value.octets())
        case BitString():
            return element(_Tag.BIT_STRING, _bits(value))
        case tuple():
            return element(_Tag.STRUCTURE, encode_values(value))
        case None | DataAccessError():
            raise ValueError(f"GOOSE carries no {value!r}")


def _is_visible(text: str) -> bool:
    return text.isascii() and text.isprintable()


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
        case _Tag.ARRAY | _Tag.STRUCTURE:
            return _decoded_all(content, depth + 1)
        case _Tag.BOOLEAN if size == 1:
            return content != b"\x00"
        case _Tag.BIT_STRING if size and content[0] < 8 and (size > 1 or not content[0]):
            bits = [bool(octet >> (7 - place) & 1) for octet in content[1:] for place in range(8)]
            return BitString(tuple(bits[: len(bits) - content[0]]))
        case _Tag.INTEGER | _Tag.UNSIGNED if 0 < size <= _LONGEST_INTEGER:
            return int.from_bytes(content, "big", signed=tag == _Tag.INTEGER)
        case _Tag.FLOAT if size in _FLOATS and content[0] == _FLOATS[size][0]:
            (number,) = struct.unpack(_FLOATS[size][1], content[1:])
            return float(number)
        case _Tag.OCTET_STRING | _Tag.BINARY_TIME:
            return content
        case _Tag.VISIBLE_STRING | _Tag.MMS_STRING:
            return content.decode("utf-8", errors="replace")
        case _Tag.UTC_TIME if size == 8:
            return Timestamp.of(content)
    raise GooseFrameError(_PLACE, "a value of a data set", f"tag 0x{tag:02x} with {size} octets")
