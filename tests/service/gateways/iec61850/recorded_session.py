"""What a client of IEC 61850 sends in a session, message by message, taken down on the way to its server."""

import socket
import threading
from collections.abc import Callable
from contextlib import suppress

from testing.ports import LOOPBACK

HEAD_BYTES = 4
"""Of a TPKT: version, reserved, length of the whole."""


def message(link: socket.socket) -> bytes:
    """Return the next TPKT. Raises OSError, ConnectionError when the other side has ended."""
    head = _exactly(link, HEAD_BYTES)
    return head + _exactly(link, int.from_bytes(head[2:], "big") - HEAD_BYTES)


def recorded(server_port: int, session: Callable[[int], None]) -> list[bytes]:
    """Return what the client of `session` sends. It is given the port to connect to."""
    sent: list[bytes] = []
    with socket.create_server((LOOPBACK, 0)) as listening:
        carrier = threading.Thread(target=_carry, args=(listening, server_port, sent))
        carrier.start()
        session(listening.getsockname()[1])
        carrier.join(20)
    assert sent, "the session has sent nothing"
    return sent


def _carry(listening: socket.socket, server_port: int, sent: list[bytes]) -> None:
    client, _ = listening.accept()
    with client, socket.create_connection((LOOPBACK, server_port)) as server:
        back = threading.Thread(target=_pass_on, args=(server, client))
        back.start()
        with suppress(OSError):
            while True:
                sent.append(message(client))
                server.sendall(sent[-1])
        with suppress(OSError):
            server.shutdown(socket.SHUT_RDWR)
        back.join(20)


def _pass_on(source: socket.socket, target: socket.socket) -> None:
    with suppress(OSError):
        while part := source.recv(65_536):
            target.sendall(part)


def _exactly(link: socket.socket, size: int) -> bytes:
    content = b""
    while len(content) < size:
        part = link.recv(size - len(content))
        if not part:
            raise ConnectionError("the other side has ended the connection")
        content += part
    return content
