"""Ethernet frames with a GOOSE message (IEC 61850-8-1 clause 18 and annex C)."""

from dataclasses import dataclass

from mms.goose.errors import GooseFrameError
from mms.goose.message import GooseMessage, decode_message, encode_message

ETHERTYPE = 0x88B8
_VLAN = 0x8100
_ADDRESSES = 12
_HEADER = 8
"""APPID, length and two reserved fields of two octets each; the length counts them."""
_SIMULATED = 0x8000
"""Bit S of the first reserved field (edition 2)."""
_SHORTEST = 60
"""Octets of an Ethernet frame without its checksum; shorter ones are padded."""


@dataclass(frozen=True, slots=True)
class GooseFrame:
    """A GOOSE message with its addresses.

    Parameters
    ----------
    destination : bytes
        Multicast address it is sent to, six octets.
    source : bytes
        Address of the sender, six octets.
    application_id : int
        APPID.
    message : GooseMessage
        The message.
    vlan_id : int or None
        Virtual LAN; 0 for a tag with the priority alone, None without a tag. Linux takes the tag away before
        a socket of one Ethertype sees the frame.
    vlan_priority : int
        Priority in the virtual LAN, 0 to 7.
    simulated : bool
        Bit S of the header: a test set sent the frame.
    """

    destination: bytes
    source: bytes
    application_id: int
    message: GooseMessage
    vlan_id: int | None = None
    vlan_priority: int = 4
    simulated: bool = False


def encode_frame(frame: GooseFrame) -> bytes:
    """Encode a frame, padded to the shortest that Ethernet knows.

    Parameters
    ----------
    frame : GooseFrame
        The frame.

    Returns
    -------
    bytes
        Its octets, without checksum.

    Raises
    ------
    ValueError
        A field is beyond what a frame can carry.
    """
    if len(frame.destination) != 6 or len(frame.source) != 6:
        raise ValueError("expected addresses of six octets")
    message = encode_message(frame.message)
    tag = b""
    if frame.vlan_id is not None:
        if not (0 <= frame.vlan_id < 1 << 12 and 0 <= frame.vlan_priority < 8):
            raise ValueError(f"no virtual LAN: {frame.vlan_id}, priority {frame.vlan_priority}")
        tag = _field(_VLAN) + _field(frame.vlan_priority << 13 | frame.vlan_id)
    header = _field(frame.application_id) + _field(_HEADER + len(message))
    reserved = _field(_SIMULATED if frame.simulated else 0) + _field(0)
    octets = frame.destination + frame.source + tag + _field(ETHERTYPE) + header + reserved + message
    return octets.ljust(_SHORTEST, b"\x00")


def decode_frame(octets: bytes) -> GooseFrame:
    """Decode a frame. Whatever the octets are, no other error comes of them than this one.

    Parameters
    ----------
    octets : bytes
        Its octets, without checksum.

    Returns
    -------
    GooseFrame
        The frame.

    Raises
    ------
    GooseFrameError
        They are no GOOSE frame.
    """
    place = _ADDRESSES
    ethertype, vlan = _number(octets, place), None
    if ethertype == _VLAN:
        vlan = _number(octets, place + 2)
        place += 4
        ethertype = _number(octets, place)
    if ethertype != ETHERTYPE:
        raise GooseFrameError("Ethertype", f"0x{ETHERTYPE:04x}", f"0x{ethertype:04x}")
    place += 2
    application_id, length, reserved = (_number(octets, place + offset) for offset in (0, 2, 4))
    if not _HEADER <= length <= len(octets) - place:
        raise GooseFrameError("length", f"{_HEADER} to {len(octets) - place}", f"{length}")
    return GooseFrame(
        destination=octets[:6],
        source=octets[6:_ADDRESSES],
        application_id=application_id,
        message=decode_message(octets[place + _HEADER : place + length]),
        vlan_id=None if vlan is None else vlan & 0xFFF,
        vlan_priority=4 if vlan is None else vlan >> 13,
        simulated=bool(reserved & _SIMULATED),
    )


def _number(octets: bytes, place: int) -> int:
    if len(octets) < place + 2:
        raise GooseFrameError("frame", f"more than {place + 1} octets", f"{len(octets)}")
    return int.from_bytes(octets[place : place + 2], "big")


def _field(number: int) -> bytes:
    if not 0 <= number < 1 << 16:
        raise ValueError(f"expected a number of 16 bits, found {number}")
    return number.to_bytes(2, "big")
