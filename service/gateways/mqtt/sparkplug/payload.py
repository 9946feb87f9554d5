"""Payloads of Sparkplug B in the encoding of Protocol Buffers.

The schema is that of the specification's chapter 6 (version 3.0), as far as an edge node needs it. No library
of it is both kept up and free to stand beside this service's others, and the little there is to encode is
below. Tests decode it by protoc.
"""

import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import IntEnum

MOST_BYTES = 64 * 1024
"""Of a command; a longer one is none for us."""

VARINT, FIXED64, BYTES, FIXED32 = 0, 1, 2, 5
LONGEST_VARINT = 10


class DataType(IntEnum):
    """Types of values, by the numbers of the specification."""

    INT32 = 3
    INT64 = 4
    DOUBLE = 10
    BOOLEAN = 11
    STRING = 12
    DATE_TIME = 13


class Quality(IntEnum):
    """The property of that name, by the numbers of the specification."""

    BAD = 0
    GOOD = 192
    STALE = 500


Value = int | float | bool | str | None


@dataclass(frozen=True, slots=True)
class Metric:
    """A value; None is null.  timestamp_ms: when it was so, UTC.  quality: None for none."""

    name: str
    type: DataType
    value: Value
    timestamp_ms: int
    quality: Quality | None = None


class PayloadError(ValueError):
    """Bytes that are no payload."""


def encode(metrics: Sequence[Metric], *, timestamp_ms: int, sequence: int | None) -> bytes:
    """Return a payload. sequence: None for that of a death, which has none."""
    parts = [_varint(1, timestamp_ms)]
    parts += [_bytes(2, _metric(metric)) for metric in metrics]
    if sequence is not None:
        parts.append(_varint(3, sequence))
    return b"".join(parts)


def is_ordered(command: bytes, name: str) -> bool:
    """Tell whether a command sets the metric of this name to true. Raises PayloadError."""
    if len(command) > MOST_BYTES:
        raise PayloadError(f"expected at most {MOST_BYTES} bytes, found {len(command)}")
    return any(
        _is_true(found, name.encode())
        for field, kind, found in _fields(command)
        if (field, kind) == (2, BYTES) and isinstance(found, bytes)
    )


def _is_true(metric: bytes, name: bytes) -> bool:
    named, true = False, False
    for field, kind, found in _fields(metric):
        if (field, kind) == (1, BYTES):
            named = found == name
        elif (field, kind) == (14, VARINT):
            true = found != 0
    return named and true


def _metric(metric: Metric) -> bytes:
    parts = [
        _text(1, metric.name),
        _varint(3, metric.timestamp_ms),
        _varint(4, metric.type),
    ]
    if metric.value is None:
        parts.append(_varint(7, 1))
    if metric.quality is not None:
        quality = _varint(1, DataType.INT32) + _varint(3, metric.quality)
        parts.append(_bytes(9, _text(1, "Quality") + _bytes(2, quality)))
    if metric.value is not None:
        parts.append(_value(metric.type, metric.value))
    return b"".join(parts)


def _value(data_type: DataType, value: int | float | bool | str) -> bytes:
    match data_type:
        case DataType.STRING:
            return _text(15, str(value))
        case DataType.BOOLEAN:
            return _varint(14, int(value))
        case DataType.DOUBLE:
            return _key(13, FIXED64) + struct.pack("<d", value)
        case DataType.INT32:
            return _varint(10, int(value) & 0xFFFF_FFFF)
        case DataType.INT64 | DataType.DATE_TIME:
            return _varint(11, int(value))


def _key(field: int, kind: int) -> bytes:
    return _number(field << 3 | kind)


def _varint(field: int, value: int) -> bytes:
    return _key(field, VARINT) + _number(value & 0xFFFF_FFFF_FFFF_FFFF)


def _text(field: int, text: str) -> bytes:
    return _bytes(field, text.encode("utf-8", "replace"))


def _bytes(field: int, content: bytes) -> bytes:
    return _key(field, BYTES) + _number(len(content)) + content


def _number(value: int) -> bytes:
    """Return a number, seven bits a byte, the lowest first."""
    encoded = bytearray()
    while value > 0x7F:
        encoded.append(value & 0x7F | 0x80)
        value >>= 7
    encoded.append(value)
    return bytes(encoded)


def _fields(message: bytes) -> Iterator[tuple[int, int, int | bytes]]:
    """Yield number, kind and content of each field. Raises PayloadError."""
    place = 0
    while place < len(message):
        key, place = _read_number(message, place)
        field, kind = key >> 3, key & 7
        if kind == VARINT:
            number, place = _read_number(message, place)
            yield field, kind, number
            continue
        length = {FIXED64: 8, FIXED32: 4}.get(kind)
        if kind == BYTES:
            length, place = _read_number(message, place)
        if length is None or field == 0 or length > len(message) - place:
            raise PayloadError(f"expected fields of Protocol Buffers, found another byte at {place}")
        yield field, kind, message[place : place + length]
        place += length


def _read_number(message: bytes, place: int) -> tuple[int, int]:
    value = 0
    for number, byte in enumerate(message[place : place + LONGEST_VARINT]):
        value |= (byte & 0x7F) << 7 * number
        if byte < 0x80:
            return value, place + number + 1
    raise PayloadError(f"expected a number at {place}, found no end of it")
