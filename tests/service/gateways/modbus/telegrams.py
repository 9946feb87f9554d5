"""Requests and answers of Modbus TCP, octet by octet: libraries send no request that is wrong."""

import socket
import struct

HEADER = struct.Struct(">HHHB")
"""Transaction, protocol, length of the rest and unit."""


def answer(link: socket.socket, request: bytes, *, unit: int = 1) -> bytes:
    """Send a function with what belongs to it; return the same of the answer."""
    link.sendall(HEADER.pack(7, 0, 1 + len(request), unit) + request)
    transaction, content = next_answer(link, unit=unit)
    assert transaction == 7
    return content


def next_answer(link: socket.socket, *, unit: int = 1) -> tuple[int, bytes]:
    """Return the transaction of the next answer, and its function with what belongs to it."""
    transaction, protocol, length, answering = HEADER.unpack(_received(link, HEADER.size))
    assert (protocol, answering) == (0, unit)
    return transaction, _received(link, length - 1)


def reading(first: int, count: int, *, transaction: int, protocol: int = 0, function: int = 4) -> bytes:
    """Return a request to read registers as it is sent."""
    return HEADER.pack(transaction, protocol, 6, 1) + struct.pack(">BHH", function, first, count)


def registers(link: socket.socket, first: int, count: int, *, function: int = 4) -> tuple[int, ...]:
    """Read registers."""
    found = answer(link, struct.pack(">BHH", function, first, count))
    assert found[:2] == bytes([function, 2 * count])
    return struct.unpack(f">{count}H", found[2:])


def _received(link: socket.socket, count: int) -> bytes:
    octets = b""
    while len(octets) < count:
        more = link.recv(count - len(octets))
        assert more, "the connection was closed"
        octets += more
    return octets
