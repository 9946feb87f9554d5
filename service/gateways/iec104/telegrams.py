"""The octets of IEC 60870-5-104: frames, application service data units, and the values in them.

Cause of transmission has two octets, common address two, information object address three, as the standard
fixes them for TCP. Clauses are those of IEC 60870-5-101 where no other standard is named.
"""

import struct
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from enum import IntEnum
from itertools import groupby
from typing import Final, Self

START: Final = 0x68
LONGEST_UNIT: Final = 249
"""Octets of a data unit; a frame has four more, beside the two of its head."""

HEAD: Final = struct.Struct("<BBBBH")
"""Type, number of objects, cause, originator, common address."""
EVERY_STATION: Final = 0xFFFF
NEGATIVE: Final = 0x40
TEST: Final = 0x80
EPOCH: Final = datetime(1970, 1, 1, tzinfo=UTC)
END_NS: Final = (datetime(2070, 1, 1, tzinfo=UTC) - EPOCH) // timedelta(microseconds=1) * 1000
"""Of the times that can be told: a year has two digits, and those from 70 on are of the last century."""
UNKNOWN_TIME: Final = struct.pack("<HBBBBB", 0, 0x80, 0, 1, 1, 0)
"""The first of January 2000 in CP56Time2a, with the bit that says that it is invalid (IV)."""


class Type(IntEnum):
    """Type identifications (7.2.1.1) that are sent or understood."""

    M_SP_NA_1 = 1
    M_ME_NB_1 = 11
    M_ME_NC_1 = 13
    M_SP_TB_1 = 30
    M_ME_TE_1 = 35
    M_ME_TF_1 = 36
    C_IC_NA_1 = 100
    C_RD_NA_1 = 102
    C_CS_NA_1 = 103


WITHOUT_TIME: Final[Mapping[Type, Type]] = {
    Type.M_SP_TB_1: Type.M_SP_NA_1,
    Type.M_ME_TE_1: Type.M_ME_NB_1,
    Type.M_ME_TF_1: Type.M_ME_NC_1,
}
"""The same without a time, for each type that has one."""


class Cause(IntEnum):
    """Causes of transmission (7.2.3)."""

    SPONTANEOUS = 3
    REQUEST = 5
    ACTIVATION = 6
    ACTIVATION_CONFIRMATION = 7
    ACTIVATION_TERMINATION = 10
    INTERROGATED = 20
    UNKNOWN_TYPE = 44
    UNKNOWN_CAUSE = 45
    UNKNOWN_STATION = 46
    UNKNOWN_OBJECT = 47


class Control(IntEnum):
    """First control octet of the frames without a number (IEC 60870-5-104, 5.3)."""

    START_ACTIVATION = 0x07
    START_CONFIRMATION = 0x0B
    STOP_ACTIVATION = 0x13
    STOP_CONFIRMATION = 0x23
    TEST_ACTIVATION = 0x43
    TEST_CONFIRMATION = 0x83


class MalformedError(ValueError):
    """What has come is no frame, or no data unit."""


@dataclass(frozen=True, slots=True)
class Value:
    """An information object. element: its octets behind the address.  time: those behind it, or none."""

    kind: Type
    element: bytes
    time: bytes = b""

    def without_time(self) -> "Value":
        """Return it as a type that has no time."""
        return Value(WITHOUT_TIME[self.kind], self.element)


@dataclass(frozen=True, slots=True)
class Unit:
    """A data unit. body: its objects, each with its address."""

    kind: int
    number: int
    cause: int
    originator: int
    station: int
    body: bytes

    @classmethod
    def read(cls, octets: bytes) -> Self:
        """Return the unit of these octets. Raises MalformedError."""
        if len(octets) < HEAD.size + 3:
            raise MalformedError(f"expected a data unit with an object, found {len(octets)} octets")
        kind, number, cause, originator, station = HEAD.unpack_from(octets)
        return cls(kind, number, cause, originator, station, octets[HEAD.size :])

    @property
    def place(self) -> int:
        """Return the address of its first object."""
        return int.from_bytes(self.body[:3], "little")

    def octets(self) -> bytes:
        """Return it as it is sent."""
        head = HEAD.pack(self.kind, self.number, self.cause, self.originator, self.station)
        return head + self.body

    def answer(self, cause: Cause, *, negative: bool = False) -> "Unit":
        """Return the same with another cause, as it goes back."""
        kept = self.cause & TEST
        return replace(self, cause=cause | kept | (NEGATIVE if negative else 0))


def single_point(*, on: bool, quality: int, time_ns: int | None) -> Value:
    """Return a single point with its time (M_SP_TB_1)."""
    return Value(Type.M_SP_TB_1, bytes([quality | on]), time_stamp(time_ns))


def scaled(value: int, *, quality: int, time_ns: int | None) -> Value:
    """Return a whole number with its time (M_ME_TE_1)."""
    return Value(Type.M_ME_TE_1, struct.pack("<hB", value, quality), time_stamp(time_ns))


def short_float(value: float, *, quality: int, time_ns: int | None) -> Value:
    """Return a number with its time (M_ME_TF_1)."""
    return Value(Type.M_ME_TF_1, struct.pack("<fB", value, quality), time_stamp(time_ns))


def time_stamp(time_ns: int | None) -> bytes:
    """Return a time as CP56Time2a, in UTC with the day of the week left out (7.2.6.18).

    One that is not known, or not of the years 1970 to 2069, is invalid.
    """
    if time_ns is None or not 0 <= time_ns < END_NS:
        return UNKNOWN_TIME
    time = EPOCH + timedelta(milliseconds=time_ns // 1_000_000)
    milliseconds = 1000 * time.second + time.microsecond // 1000
    return struct.pack("<HBBBBB", milliseconds, time.minute, time.hour, time.day, time.month, time.year % 100)


def units_of(values: Iterable[tuple[int, Value]], cause: Cause, station: int) -> Iterator[Unit]:
    """Yield the units that tell these values by their addresses, as few as neighbours allow."""
    for kind, group in groupby(values, key=lambda one: one[1].kind):
        objects = [place.to_bytes(3, "little") + value.element + value.time for place, value in group]
        most = (LONGEST_UNIT - HEAD.size) // len(objects[0])
        for begin in range(0, len(objects), most):
            part: Sequence[bytes] = objects[begin : begin + most]
            yield Unit(kind, len(part), cause, 0, station, b"".join(part))


def unnumbered(control: Control) -> bytes:
    """Return a frame of the U format."""
    return bytes([START, 4, control, 0, 0, 0])


def acknowledging(received: int) -> bytes:
    """Return a frame of the S format. received: number of the next unit that is expected."""
    return struct.pack("<BBHH", START, 4, 1, received << 1)


def numbered(sent: int, received: int, unit: bytes) -> bytes:
    """Return a frame of the I format."""
    return struct.pack("<BBHH", START, 4 + len(unit), sent << 1, received << 1) + unit


def frames(buffer: bytearray) -> Iterator[bytes]:
    """Take whole frames off a buffer; yield each without its head. Raises MalformedError."""
    while len(buffer) >= 2:
        if buffer[0] != START or not 4 <= buffer[1] <= LONGEST_UNIT + 4:
            raise MalformedError(f"expected the head of a frame, found {bytes(buffer[:2]).hex(' ')}")
        end = 2 + buffer[1]
        if len(buffer) < end:
            return
        frame = bytes(buffer[2:end])
        del buffer[:end]
        yield frame
