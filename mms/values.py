"""MMS data as Python values (IEC 61850-8-1 clause 8).

BOOLEAN bool | INT, ENUMERATED int | FLOAT float | strings str | octet string bytes | bit string BitString
UtcTime, BinaryTime Timestamp | structure, array tuple | an error in place of a value DataAccessError
"""

from dataclasses import dataclass
from enum import Enum, IntEnum
from typing import Final, TypeAlias

NANOSECONDS_PER_SECOND: Final = 1_000_000_000
NANOSECONDS_PER_MILLISECOND: Final = 1_000_000
_FRACTION_BITS: Final = 24


class DataAccessError(Enum):
    """Why a peer gave no value for one member of a data set or structure (ISO 9506-2, DataAccessError)."""

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
    """An MMS bit string.

    Parameters
    ----------
    bits : tuple of bool
        The bits in the order they are sent; the first is bit 0 of IEC 61850-8-1.
    """

    bits: tuple[bool, ...]

    @classmethod
    def of(cls, integer: int, size: int) -> "BitString":
        """Make a bit string from an integer.

        Parameters
        ----------
        integer : int
            The bits, the least significant first.
        size : int
            Number of bits.

        Returns
        -------
        BitString
            The bit string.
        """
        return cls(tuple(bool(integer >> position & 1) for position in range(size)))

    @property
    def integer(self) -> int:
        """The bits as an integer, the first as its least significant."""
        return sum(1 << position for position, bit in enumerate(self.bits) if bit)

    def __str__(self) -> str:
        return "".join("1" if bit else "0" for bit in self.bits)


class Validity(IntEnum):
    """Validity of a value (IEC 61850-7-3), as its two bits are sent."""

    GOOD = 0b00
    RESERVED = 0b10
    INVALID = 0b01
    QUESTIONABLE = 0b11

    def __str__(self) -> str:
        return self.name.lower()


@dataclass(frozen=True, slots=True)
class Quality:
    """Quality of a value (IEC 61850-7-3): 13 bits, all clear when good.

    Parameters
    ----------
    validity : Validity
        Whether the value may be used.
    overflow : bool
        The value is beyond what its type can hold.
    out_of_range : bool
        The value is beyond its predefined range.
    bad_reference : bool
        The reference of the measurement is not calibrated.
    oscillatory : bool
        The value changes too often.
    failure : bool
        A supervision function found a failure.
    old_data : bool
        The value has not been updated for too long.
    inconsistent : bool
        An evaluation found the value inconsistent.
    inaccurate : bool
        The value does not have the stated accuracy.
    substituted : bool
        The value is substituted, not from the process.
    test : bool
        The value is not to be used for operation.
    operator_blocked : bool
        An operator has blocked the update of the value.

    References
    ----------
    IEC 61850-7-3, Quality.
    """

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
        """The quality as the bit string that is sent."""
        first, second = bool(self.validity >> 1), bool(self.validity & 1)
        flags = (getattr(self, name) for name in self.__slots__[1:])
        return BitString((first, second, *flags))

    @classmethod
    def of(cls, bits: BitString) -> "Quality":
        """Make a quality from a bit string of a peer.

        Parameters
        ----------
        bits : BitString
            The bit string.

        Returns
        -------
        Quality
            The quality.

        Raises
        ------
        ValueError
            The bit string has other than 13 bits.
        """
        if len(bits.bits) != 13:
            raise ValueError(f"a quality has 13 bits, not {len(bits.bits)}")
        return cls(Validity(bits.bits[0] << 1 | bits.bits[1]), *bits.bits[2:])


GOOD: Final = Quality()


@dataclass(frozen=True, slots=True)
class Timestamp:
    """Point in time with the quality of the clock (IEC 61850-8-1, UtcTime).

    UtcTime resolves 2**-24 s (60 ns).

    Parameters
    ----------
    ns : int
        Time since 1970 [ns, UTC].
    quality : int
        Last octet of UtcTime. Bit 7: leap seconds known; bit 6: clock failure; bit 5: clock not synchronised;
        bits 0 to 4: number of significant bits in the fraction (31: unspecified).

    References
    ----------
    IEC 61850-8-1 clause 8, TimeStamp and TimeQuality.
    """

    ns: int
    quality: int = 0x0A

    @property
    def leap_seconds_known(self) -> bool:
        """Whether the clock takes leap seconds into account."""
        return bool(self.quality & 0x80)

    @property
    def clock_failure(self) -> bool:
        """Whether the time source is unreliable."""
        return bool(self.quality & 0x40)

    @property
    def clock_not_synchronised(self) -> bool:
        """Whether the clock is not synchronised with an external source."""
        return bool(self.quality & 0x20)

    def octets(self) -> bytes:
        """Encode the time as UtcTime.

        Returns
        -------
        bytes
            Eight octets.

        Raises
        ------
        ValueError
            The time is outside 1970 to 2106, or the quality is no octet.
        """
        seconds, rest = divmod(self.ns, NANOSECONDS_PER_SECOND)
        fraction = round(rest * (1 << _FRACTION_BITS) / NANOSECONDS_PER_SECOND)
        seconds += fraction >> _FRACTION_BITS
        fraction &= (1 << _FRACTION_BITS) - 1
        if not 0 <= seconds < 1 << 32 or not 0 <= self.quality < 256:
            raise ValueError(f"not a UtcTime: {self.ns} ns, quality {self.quality}")
        return seconds.to_bytes(4, "big") + fraction.to_bytes(3, "big") + bytes([self.quality])

    @classmethod
    def of(cls, octets: bytes) -> "Timestamp":
        """Decode a UtcTime.

        Parameters
        ----------
        octets : bytes
            Its eight octets.

        Returns
        -------
        Timestamp
            The time.
        """
        fraction = int.from_bytes(octets[4:7], "big")
        ns = int.from_bytes(octets[:4], "big") * NANOSECONDS_PER_SECOND + round(
            fraction * NANOSECONDS_PER_SECOND / (1 << _FRACTION_BITS)
        )
        return cls(ns, octets[7])


Value: TypeAlias = (
    bool | int | float | str | bytes | Timestamp | BitString | DataAccessError | tuple["Value", ...] | None
)
