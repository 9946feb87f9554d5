"""Sockets of this process that the library holds. It gives them to nobody: they are found by descriptor."""

import os
import socket
from contextlib import suppress
from pathlib import Path
from typing import Final

_DESCRIPTORS: Final = Path("/proc/self/fd")
_ANY: Final = "0.0.0.0"  # noqa: S104 - compared, not listened at


def sockets() -> dict[int, str]:
    """Return the sockets of this process.

    Returns
    -------
    dict of int to str
        Their names, "socket:[inode]", by descriptor.
    """
    found = {}
    for entry in _DESCRIPTORS.iterdir():
        with suppress(OSError):  # closed meanwhile
            name = str(entry.readlink())
            if name.startswith("socket:"):
                found[int(entry.name)] = name
    return found


def connection_at(descriptor: int, own: tuple[str, int]) -> socket.socket | None:
    """Return a descriptor's TCP connection if it is at our port.

    It is a duplicate, which nobody else closes; the caller does.

    Parameters
    ----------
    descriptor : int
        Of a socket.
    own : tuple of str and int
        Address and port at this end.

    Returns
    -------
    socket.socket or None
        The connection.
    """
    try:
        duplicate = os.dup(descriptor)
    except OSError:  # closed meanwhile
        return None
    try:
        candidate = socket.socket(socket.AF_INET, socket.SOCK_STREAM, fileno=duplicate)
    except OSError:
        os.close(duplicate)
        return None
    if _is_connection_at(candidate, own):
        return candidate
    candidate.close()
    return None


def _is_connection_at(candidate: socket.socket, own: tuple[str, int]) -> bool:
    try:
        address, port = candidate.getsockname()[:2]
        candidate.getpeername()
    except (OSError, ValueError):
        return False
    return port == own[1] and own[0] in (address, _ANY)
