"""A limit of time for the TLS handshake of a client, which the MMS library waits for without end.

The library offers no way to stop waiting, but it notices the end of the TCP connection, and the operating
system lets any part of this process shut a connection down.
"""

import os
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

_DESCRIPTORS: Final = Path("/proc/self/fd")


@contextmanager
def end_connections_after(own: tuple[str, int], limit_s: float) -> Iterator[None]:
    """End the connections to one of our ports made within the block that still stand when the limit is over.

    Parameters
    ----------
    own : tuple of str and int
        Address and port at this end.
    limit_s : float
        Time after which they are ended [s].

    Yields
    ------
    None
        Nothing; the block accepts connections.
    """
    older = frozenset(_sockets().values())

    def end() -> None:
        for descriptor, name in _sockets().items():
            if name not in older:
                _shut_down(descriptor, own)

    timer = threading.Timer(limit_s, end)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def _sockets() -> dict[int, str]:
    """Return the descriptors of this process's sockets, each with its name "socket:[inode]"."""
    found = {}
    for entry in _DESCRIPTORS.iterdir():
        with suppress(OSError):  # closed meanwhile
            name = str(entry.readlink())
            if name.startswith("socket:"):
                found[int(entry.name)] = name
    return found


def _shut_down(descriptor: int, own: tuple[str, int]) -> None:
    """Shut a connection down if it is at our port. It works on a duplicate, which nobody else closes."""
    with suppress(OSError):
        duplicate = os.dup(descriptor)
        try:
            candidate = socket.socket(socket.AF_INET, socket.SOCK_STREAM, fileno=duplicate)
        except OSError:
            os.close(duplicate)
            return
        with candidate:
            if candidate.getsockname() == own and candidate.getpeername():
                candidate.shutdown(socket.SHUT_RDWR)
