"""Conversion between the library's MmsValue and Python values, as `mms.values` defines them."""

import ctypes
import math
from collections.abc import Callable
from enum import IntEnum
from typing import Final

from mms.values import NANOSECONDS_PER_MILLISECOND, BitString, DataAccessError, Quality, Timestamp, Value

_NESTING_LIMIT: Final = 16  # IEC 61850-7-3 needs 4 levels; a hostile peer may send thousands


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
    """Convert the library's value to a Python value.

    Visible strings are read as Latin-1, so that a relay's octets survive whatever they are.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    pointer : int or None
        Pointer to the MmsValue.
    nesting : int
        Depth of the structure that holds the value.

    Returns
    -------
    Value
        The Python value; None for no pointer.

    Raises
    ------
    ValueError
        The type has no use in IEC 61850, or structures are nested too deep.

    References
    ----------
    IEC 61850-8-1 clause 8.
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
        int(lib.MmsValue_getBinaryTimeAsUtcMs(pointer)) * NANOSECONDS_PER_MILLISECOND, 0
    ),
    _Type.DATA_ACCESS_ERROR: _data_access_error,
}


class TypeMismatchError(ValueError):
    """A Python value does not fit the MMS type it is for.

    Parameters
    ----------
    expected : str
        What the type takes.
    found : object
        The value.
    """

    def __init__(self, expected: str, found: object) -> None:
        super().__init__(f"expected {expected}, found {found!r}")
        self.expected = expected
        self.found = repr(found)


def assign(lib: ctypes.CDLL, pointer: int, value: Value | Quality, *, longest_string: int = 255) -> None:
    """Put a Python value into the library's value, whose type is fixed.

    In a structure or array, None leaves an element as it is.

    Parameters
    ----------
    lib : ctypes.CDLL
        The library.
    pointer : int
        Pointer to the MmsValue.
    value : Value or Quality
        The Python value.
    longest_string : int
        Longest string that the attribute takes [octet].

    Raises
    ------
    TypeMismatchError
        The value does not fit the type.
    """
    kind = int(lib.MmsValue_getType(pointer))
    if kind in (_Type.STRUCTURE, _Type.ARRAY):
        _assign_elements(lib, pointer, value)
        return
    writer = _WRITERS.get(kind)
    if writer is None:
        raise TypeMismatchError("a type of IEC 61850", f"MMS type {kind}")
    writer(lib, pointer, value)
    if isinstance(value, str) and len(value.encode("utf-8")) > longest_string:
        raise TypeMismatchError(f"a string of at most {longest_string} octets", value)


def _assign_elements(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    size = int(lib.MmsValue_getArraySize(pointer))
    if not isinstance(value, tuple) or len(value) != size:
        raise TypeMismatchError(f"a tuple of {size} values", value)
    for index, element in enumerate(value):
        if element is not None:
            assign(lib, lib.MmsValue_getElement(pointer, index), element)


def _write_boolean(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    if not isinstance(value, bool):
        raise TypeMismatchError("a bool", value)
    lib.MmsValue_setBoolean(pointer, value)


def _write_integer(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    """Write through the setter of the attribute's width, because the library silently ignores wider ones."""
    if not isinstance(value, int) or isinstance(value, bool):
        raise TypeMismatchError("an int", value)
    setters = (lib.MmsValue_setInt64, lib.MmsValue_setInt32, lib.MmsValue_setInt16, lib.MmsValue_setInt8)
    for setter, bits in zip(setters, (64, 32, 16, 8), strict=True):
        if -(1 << bits - 1) <= value < 1 << bits - 1:
            setter(pointer, value)
            if int(lib.MmsValue_toInt64(pointer)) == value:
                return
    raise TypeMismatchError("an int that fits the attribute's type", value)


def _write_unsigned(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    if not isinstance(value, int) or isinstance(value, bool):
        raise TypeMismatchError("an int", value)
    setters = (lib.MmsValue_setUint32, lib.MmsValue_setUint16, lib.MmsValue_setUint8)
    for setter, bits in zip(setters, (32, 16, 8), strict=True):
        if 0 <= value < 1 << bits:
            setter(pointer, value)
            if int(lib.MmsValue_toUint32(pointer)) == value:
                return
    raise TypeMismatchError("an int that fits the attribute's type", value)


def _write_float(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    if not isinstance(value, int | float) or isinstance(value, bool):
        raise TypeMismatchError("a float", value)
    lib.MmsValue_setDouble(pointer, value)
    if math.isinf(float(lib.MmsValue_toDouble(pointer))) and not math.isinf(value):
        raise TypeMismatchError("a float within the attribute's 32 bits", value)


def _write_bit_string(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    size = int(lib.MmsValue_getBitStringSize(pointer))
    bits = value.bits if isinstance(value, Quality) else value
    if not isinstance(bits, BitString) or len(bits.bits) != size:
        raise TypeMismatchError(f"a BitString of {size} bits", value)
    for position, bit in enumerate(bits.bits):
        lib.MmsValue_setBitStringBit(pointer, position, bit)


def _write_octet_string(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    longest = int(lib.MmsValue_getOctetStringMaxSize(pointer))
    if not isinstance(value, bytes) or len(value) > longest:
        raise TypeMismatchError(f"at most {longest} bytes", value)
    lib.MmsValue_setOctetString(pointer, value, len(value))


def _write_visible_string(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    if not isinstance(value, str) or not value.isascii() or "\0" in value:
        raise TypeMismatchError("an ASCII str", value)
    lib.MmsValue_setVisibleString(pointer, value.encode("ascii"))


def _write_string(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    if not isinstance(value, str) or "\0" in value:
        raise TypeMismatchError("a str", value)
    lib.MmsValue_setMmsString(pointer, value.encode("utf-8"))


def _write_time(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    if not isinstance(value, Timestamp):
        raise TypeMismatchError("a Timestamp", value)
    try:
        octets = value.octets()
    except ValueError as error:
        raise TypeMismatchError("a Timestamp from 1970 to 2106", value) from error
    lib.MmsValue_setUtcTimeByBuffer(pointer, octets)


def _write_binary_time(lib: ctypes.CDLL, pointer: int, value: Value | Quality) -> None:
    if not isinstance(value, Timestamp) or value.ns < 0:
        raise TypeMismatchError("a Timestamp from 1970 on", value)
    lib.MmsValue_setBinaryTime(pointer, value.ns // NANOSECONDS_PER_MILLISECOND)


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
