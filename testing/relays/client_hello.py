"""The first message of a TLS client, read octet by octet (RFC 8446, 4.1.2; RFC 5246, 7.4.1.2)."""

import socket
import struct
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from testing.ports import LOOPBACK

TLS_1_2, TLS_1_3 = 0x0303, 0x0304
HANDSHAKE, CLIENT_HELLO, SUPPORTED_VERSIONS = 22, 1, 43
RENEGOTIATION_INFO = 0x00FF
"""A signal among the cipher suites, no suite (RFC 5746)."""

PATIENCE_S = 10.0


@dataclass(frozen=True, slots=True)
class ClientHello:
    """What a client offers: versions, and cipher suites in its order, both as the numbers of IANA."""

    versions: tuple[int, ...]
    suites: tuple[int, ...]

    @classmethod
    def of(cls, message: bytes) -> "ClientHello":
        """Read the body of a handshake message."""
        kind, length = message[0], int.from_bytes(message[1:4], "big")
        assert (kind, length) == (CLIENT_HELLO, len(message) - 4)
        legacy_version = int.from_bytes(message[4:6], "big")
        session, rest = _split(message[38:], 1)
        assert len(session) <= 32
        suites, rest = _split(rest, 2)
        _compressions, rest = _split(rest, 1)
        extensions, rest = _split(rest, 2)
        assert not rest
        versions: tuple[int, ...] = (legacy_version,)
        while extensions:
            number = int.from_bytes(extensions[:2], "big")
            content, extensions = _split(extensions[2:], 2)
            if number == SUPPORTED_VERSIONS:
                versions = _numbers(_split(content, 1)[0])
        offered = tuple(one for one in _numbers(suites) if one != RENEGOTIATION_INFO)
        return cls(versions, offered)


def _split(content: bytes, octets: int) -> tuple[bytes, bytes]:
    """Take off a vector that begins with its length, which has so many octets."""
    end = octets + int.from_bytes(content[:octets], "big")
    assert end <= len(content)
    return content[octets:end], content[end:]


def _numbers(content: bytes) -> tuple[int, ...]:
    return struct.unpack(f">{len(content) // 2}H", content)


def offered_by(connect: Callable[[int], object]) -> ClientHello:
    """Return the first message of a client that connects to the port it is given."""
    with socket.create_server((LOOPBACK, 0)) as listener, ThreadPoolExecutor(1) as threads:
        listener.settimeout(PATIENCE_S)
        attempt = threads.submit(connect, listener.getsockname()[1])
        connection, _ = listener.accept()
        with connection:
            connection.settimeout(PATIENCE_S)
            kind, _version, length = struct.unpack(">BHH", _exactly(connection, 5))
            assert kind == HANDSHAKE
            hello = ClientHello.of(_exactly(connection, length))
        listener.close()
        attempt.exception(PATIENCE_S)
    return hello


def _exactly(connection: socket.socket, number: int) -> bytes:
    content = b""
    while len(content) < number:
        more = connection.recv(number - len(content))
        assert more, "the client hung up"
        content += more
    return content
