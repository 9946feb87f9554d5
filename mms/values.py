"""MMS data as Python values (IEC 61850-8-1 clause 8): decoding from C, assigning into C.

BOOLEAN bool | INT, ENUMERATED int | FLOAT float | strings str | octet string bytes | bit string BitString
UtcTime, BinaryTime Timestamp | structure, array tuple | an error in place of a value DataAccessError
"""

import ctypes
import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum, IntEnum
from typing import Final, TypeAlias

_SECOND_NS: Final = 1_000_000_000
_MILLISECOND_NS: Final = 1_000_000
_FRACTION_BITS: Final = 24
_NESTING_LIMIT: Final = 16  # IEC 61850-7-3 needs 4; a hostile peer may send thousands


class DataAccessError(Enum):
    """Why a peer gave no value for one member of a data set or structure (ISO 9506-2 DataAccessError)."""

    OBJECT_INVALIDATED = 0
    HARDWARE_FAULT = 1
    TEMPORARILY_UNAVAILABLE = 2
    ACCESS_DENIED = 3
    UNDEFINED = 4
    INVALID_ADDRESS = 5
    TYPE_UNSUPPORTED = 6
    TYPE_INCONSISTENT = 7
    ATTRIBUTE_INCONSISTENT = 8
    ACCESS_UNSUPPORTED = 9
    NON_EXISTENT = 10
    VALUE_INVALID = 11
    UNKNOWN = 12


@dataclass(frozen=True, slots=True)
class BitString:
    """An MMS bit string; `bits[0]` is the first bit sent, bit 0 of IEC 61850-8-1."""

    bits: tuple[bool, ...]

    @classmethod
    def of(cls, integer: int, size: int) -> "BitString":
        """The `size` bits of `integer`, the least significant first."""
        return cls(tuple(bool(integer >> position & 1) for position in range(size)))

    @property
    def integer(self) -> int:
        return sum(1 << position for position, bit in enumerate(self.bits) if bit)

    def __str__(self) -> str:
        return "".join("1" if bit else "0" for bit in self.bits)


class Validity(IntEnum):
    """IEC 61850-7-3 validity, as the two bits are sent."""

    GOOD = 0b00
    RESERVED = 0b10
    INVALID = 0b01
    QUESTIONABLE = 0b11

    def __str__(self) -> str:
        return self.name.lower()


@dataclass(frozen=True, slots=True)
class Quality:
    """IEC 61850-7-3 quality of a value: 13 bits, all clear when good."""

    validity: Validity = Validity.GOOD
    overflow: bool = False
    out_of_range: bool = False
    bad_reference: bool = False
    oscillatory: bool = False
    failure: bool = False
    old_data: bool = False
    inconsistent: bool = False
    inaccurate: bool = False
    substituted: bool = False
    test: bool = False
    operator_blocked: bool = False

    @property
    def bits(self) -> BitString:
        first, second = bool(self.validity >> 1), bool(self.validity & 1)
        flags = (getattr(self, name) for name in self.__slots__[1:])
        return BitString((first, second, *flags))

    @classmethod
    def of(cls, bits: BitString) -> "Quality":
        """The quality in a bit string read from a peer; ValueError unless it has 13 bits."""
        if len(bits.bits) != 13:
            raise ValueError(f"a quality has 13 bits, not {len(bits.bits)}")
        return cls(Validity(bits.bits[0] << 1 | bits.bits[1]), *bits.bits[2:])


GOOD: Final = Quality()


@dataclass(frozen=True, slots=True)
class Timestamp:
    """A point in time, integer nanoseconds UTC, with the clock's own quality (IEC 61850-8-1 UtcTime).

    UtcTime resolves 2**-24 s (60 ns); `quality` is its last octet: bit 7 leap seconds known, bit 6 clock
    failure, bit 5 clock not synchronised, bits 0..4 the number of significant bits in the fraction (31:
    unspecified).
    """

    ns: int
    quality: int = 0x0A

    @property
    def leap_seconds_known(self) -> bool:
        return bool(self.quality & 0x80)

    @property
    def clock_failure(self) -> bool:
        return bool(self.quality & 0x40)

    @property
    def clock_not_synchronised(self) -> bool:
        return bool(self.quality & 0x20)

    def octets(self) -> bytes:
        """The eight octets of UtcTime; ValueError outside 1970..2106."""
        seconds, rest = divmod(self.ns, _SECOND_NS)
        fraction = round(rest * (1 << _FRACTION_BITS) / _SECOND_NS)
        seconds += fraction >> _FRACTION_BITS
        fraction &= (1 << _FRACTION_BITS) - 1
        if not 0 <= seconds < 1 << 32 or not 0 <= self.quality < 256:
            raise ValueError(f"not a UtcTime: {self.ns} ns, quality {self.quality}")
        return seconds.to_bytes(4, "big") + fraction.to_bytes(3, "big") + bytes([self.quality])

    @classmethod
    def of(cls, octets: bytes) -> "Timestamp":
        fraction = int.from_bytes(octets[4:7], "big")
        ns = int.from_bytes(octets[:4], "big") * _SECOND_NS + round(
            fraction * _SECOND_NS / (1 << _FRACTION_BITS)
        )
        return cls(ns, octets[7])


Value: TypeAlias = (
    bool | int | float | str | bytes | Timestamp | BitString | DataAccessError | tuple["Value", ...] | None
)


class _Type(IntEnum):
    """The library's MmsType."""

    ARRAY = 0
    STRUCTURE = 1
    BOOLEAN = 2
    BIT_STRING = 3
    INTEGER = 4
    UNSIGNED = 5
    FLOAT = 6
    OCTET_STRING = 7
    VISIBLE_STRING = 8
    BINARY_TIME = 10
    STRING = 13
    UTC_TIME = 14
    DATA_ACCESS_ERROR = 15


def decode(lib: ctypes.CDLL, pointer: int | None, nesting: int = 0) -> Value:
    """The Python value of the MmsValue at `pointer`; ValueError for a type of no use in IEC 61850.

    Visible strings are read as Latin-1: a relay's bytes, whatever they are, survive.
    """
    if pointer is None:
        return None
    kind = int(lib.MmsValue_getType(pointer))
    if kind in (_Type.STRUCTURE, _Type.ARRAY):
        if nesting >= _NESTING_LIMIT:
            raise ValueError(f"structure nested deeper than {_NESTING_LIMIT}")
        size = int(lib.MmsValue_getArraySize(pointer))
        return tuple(
            decode(lib, lib.MmsValue_getElement(pointer, index), nesting + 1) for index in range(size)
        )
    reader = _READERS.get(kind)
    if reader is None:
        raise ValueError(f"MMS data of type {kind} has no use in IEC 61850")
    return reader(lib, pointer)


def _bit_string(lib: ctypes.CDLL, pointer: int) -> BitString:
    size = int(lib.MmsValue_getBitStringSize(pointer))
    return BitString(tuple(bool(lib.MmsValue_getBitStringBit(pointer, position)) for position in range(size)))


def _octet_string(lib: ctypes.CDLL, pointer: int) -> bytes:
    size = int(lib.MmsValue_getOctetStringSize(pointer))
    return ctypes.string_at(lib.MmsValue_getOctetStringBuffer(pointer), size) if size else b""


def _data_access_error(lib: ctypes.CDLL, pointer: int) -> DataAccessError:
    code = int(lib.MmsValue_getDataAccessError(pointer))
    return DataAccessError(code) if 0 <= code <= DataAccessError.UNKNOWN.value else DataAccessError.UNKNOWN


_READERS: Final[dict[int, Callable[[ctypes.CDLL, int], Value]]] = {
    _Type.BOOLEAN: lambda lib, pointer: bool(lib.MmsValue_getBoolean(pointer)),
    _Type.INTEGER: lambda lib, pointer: int(lib.MmsValue_toInt64(pointer)),
    _Type.UNSIGNED: lambda lib, pointer: int(lib.MmsValue_toInt64(pointer)),
    _Type.FLOAT: lambda lib, pointer: float(lib.MmsValue_toDouble(pointer)),
    _Type.BIT_STRING: _bit_string,
    _Type.OCTET_STRING: _octet_string,
    _Type.VISIBLE_STRING: lambda lib, pointer: (lib.MmsValue_toString(pointer) or b"").decode("latin-1"),
    _Type.STRING: lambda lib, pointer: (lib.MmsValue_toString(pointer) or b"").decode("utf-8", "replace"),
    _Type.UTC_TIME: lambda lib, pointer: Timestamp.of(
        ctypes.string_at(lib.MmsValue_getUtcTimeBuffer(pointer), 8)
    ),
    _Type.BINARY_TIME: lambda lib, pointer: Timestamp(
        int(lib.MmsValue_getBinaryTimeAsUtcMs(pointer)) * _MILLISECOND_NS, 0
    ),
    _Type.DATA_ACCESS_ERROR: _data_access_error,
}


class Mismatch(ValueError):  # noqa: N818 (what went wrong)
    """A Python value does not fit the MMS type it is for."""

    def __init__(self, expected: str, found: object) -> None:
        super().__init__(f"expected {expected}, found {found!r}")
        self.expected = expected
        self.found = repr(found)


def assign(lib: ctypes.CDLL, pointer: int, value: Value | Quality, *, longest_string: int = 255) -> None:
    """Put a Python value into the MmsValue at `pointer`, whose type stands; Mismatch if it does not fit.

    In a structure or array, None leaves an element as it is.
    """
    kind = int(lib.MmsValue_getType(pointer))
    if kind in (_Type.STRUCTURE, _Type.ARRAY):
        _assign_elements(lib, pointer, value)
        return
    writer = _WRITERS.get(kind)
    if writer is None:
        raise Mismatch("a type of IEC 61850", f"MMS type {kind}")
    writer(lib, pointer, value)
    if isinstance(value, str) and len(value.encode("utf-8")) > longest_string:
        raise Mismatch(f"a string of at most {longest_string} octets", value)


def _assign_elements(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    size = int(lib.MmsValue_getArraySize(pointer))
    if not isinstance(value, tuple) or len(value) != size:
        raise Mismatch(f"a tuple of {size} values", value)
    for index, element in enumerate(value):
        if element is not None:
            assign(lib, lib.MmsValue_getElement(pointer, index), element)


def _write_boolean(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    if not isinstance(value, bool):
        raise Mismatch("a bool", value)
    lib.MmsValue_setBoolean(pointer, value)


def _write_integer(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    """Through the setter of the width the attribute has: the library silently ignores the wider ones."""
    if not isinstance(value, int) or isinstance(value, bool):
        raise Mismatch("an int", value)
    setters = (lib.MmsValue_setInt64, lib.MmsValue_setInt32, lib.MmsValue_setInt16, lib.MmsValue_setInt8)
    for setter, bits in zip(setters, (64, 32, 16, 8), strict=True):
        if -(1 << bits - 1) <= value < 1 << bits - 1:
            setter(pointer, value)
            if int(lib.MmsValue_toInt64(pointer)) == value:
                return
    raise Mismatch("an int that fits the attribute's type", value)


def _write_unsigned(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    if not isinstance(value, int) or isinstance(value, bool):
        raise Mismatch("an int", value)
    setters = (lib.MmsValue_setUint32, lib.MmsValue_setUint16, lib.MmsValue_setUint8)
    for setter, bits in zip(setters, (32, 16, 8), strict=True):
        if 0 <= value < 1 << bits:
            setter(pointer, value)
            if int(lib.MmsValue_toUint32(pointer)) == value:
                return
    raise Mismatch("an int that fits the attribute's type", value)


def _write_float(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    if not isinstance(value, int | float) or isinstance(value, bool):
        raise Mismatch("a float", value)
    lib.MmsValue_setDouble(pointer, value)
    if math.isinf(float(lib.MmsValue_toDouble(pointer))) and not math.isinf(value):
        raise Mismatch("a float within the attribute's 32 bits", value)


def _write_bit_string(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    size = int(lib.MmsValue_getBitStringSize(pointer))
    bits = value.bits if isinstance(value, Quality) else value
    if not isinstance(bits, BitString) or len(bits.bits) != size:
        raise Mismatch(f"a BitString of {size} bits", value)
    for position, bit in enumerate(bits.bits):
        lib.MmsValue_setBitStringBit(pointer, position, bit)


def _write_octet_string(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    longest = int(lib.MmsValue_getOctetStringMaxSize(pointer))
    if not isinstance(value, bytes) or len(value) > longest:
        raise Mismatch(f"at most {longest} bytes", value)
    lib.MmsValue_setOctetString(pointer, value, len(value))


def _write_visible_string(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    if not isinstance(value, str) or not value.isascii() or "\0" in value:
        raise Mismatch("an ASCII str", value)
    lib.MmsValue_setVisibleString(pointer, value.encode("ascii"))


def _write_string(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    if not isinstance(value, str) or "\0" in value:
        raise Mismatch("a str", value)
    lib.MmsValue_setMmsString(pointer, value.encode("utf-8"))


def _write_time(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    if not isinstance(value, Timestamp):
        raise Mismatch("a Timestamp", value)
    try:
        octets = value.octets()
    except ValueError as error:
        raise Mismatch("a Timestamp from 1970 to 2106", value) from error
    lib.MmsValue_setUtcTimeByBuffer(pointer, octets)


def _write_binary_time(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    if not isinstance(value, Timestamp) or value.ns < 0:
        raise Mismatch("a Timestamp from 1970 on", value)
    lib.MmsValue_setBinaryTime(pointer, value.ns // _MILLISECOND_NS)


_WRITERS: Final[dict[int, Callable[[ctypes.CDLL, int, Value | Quality], None]]] = {
    _Type.BOOLEAN: _write_boolean,
    _Type.INTEGER: _write_integer,
    _Type.UNSIGNED: _write_unsigned,
    _Type.FLOAT: _write_float,
    _Type.BIT_STRING: _write_bit_string,
    _Type.OCTET_STRING: _write_octet_string,
    _Type.VISIBLE_STRING: _write_visible_string,
    _Type.STRING: _write_string,
    _Type.UTC_TIME: _write_time,
    _Type.BINARY_TIME: _write_binary_time,
}
