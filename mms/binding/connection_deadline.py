"""A limit of time for calls that the MMS library would never end by itself.

The library waits for ever for a TLS handshake that nobody answers, and for a list of names of which more
follows each time. It offers no way to stop it, but it notices the end of the TCP connection, and the
operating system lets any part of this process shut a connection down.
"""

import os
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

_DESCRIPTORS: Final = Path("/proc/self/fd")


ConnectionFilter = Callable[[socket.socket], bool]


def connections_between(
    *, own: tuple[str, int] | None = None, peer: tuple[str, int] | None = None
) -> ConnectionFilter:
    """Make a filter that selects TCP connections by their ends.

    Parameters
    ----------
    own : tuple of str and int, optional
        Address and port at this end. Any by default.
    peer : tuple of str and int, optional
        Address and port at the other end. Any by default.

    Returns
    -------
    ConnectionFilter
        A function that tells whether a connected socket is selected.
    """

    def is_selected(connection: socket.socket) -> bool:
        ends = (connection.getsockname(), connection.getpeername())
        return own in (None, ends[0]) and peer in (None, ends[1])

    return is_selected


@contextmanager
def end_connections_after(
    is_selected: ConnectionFilter, limit_s: float, *, before: frozenset[str] | None = None
) -> Iterator[threading.Event]:
    """End selected connections made within the block that still stand when the limit is over.

    A connection that another thread makes meanwhile is ended too if it is selected.

    Parameters
    ----------
    is_selected : ConnectionFilter
        Tells which connections to end.
    limit_s : float
        Time after which they are ended [s].
    before : frozenset of str, optional
        Result of `open_sockets` before the connections were made, for connections older than the block. By
        default the sockets that are open when the block begins.

    Yields
    ------
    threading.Event
        Set when the limit is over.
    """
    older = open_sockets() if before is None else before
    over = threading.Event()

    def end() -> None:
        over.set()
        for descriptor, name in _sockets().items():
            if name not in older:
                _shut_down(descriptor, is_selected)

    timer = threading.Timer(limit_s, end)
    timer.daemon = True
    timer.start()
    try:
        yield over
    finally:
        timer.cancel()


def open_sockets() -> frozenset[str]:
    """List the sockets of this process.

    Returns
    -------
    frozenset of str
        One name "socket:[inode]" for each.
    """
    return frozenset(_sockets().values())


def _sockets() -> dict[int, str]:
    """Return the descriptors of this process's sockets, each with its name "socket:[inode]"."""
    found = {}
    for entry in _DESCRIPTORS.iterdir():
        with suppress(OSError):  # closed meanwhile
            name = str(entry.readlink())
            if name.startswith("socket:"):
                found[int(entry.name)] = name
    return found


def _shut_down(descriptor: int, is_selected: ConnectionFilter) -> None:
    """Shut a connection down if it is selected. It works on a duplicate, which nobody else closes."""
    with suppress(OSError):
        duplicate = os.dup(descriptor)
        try:
            candidate = socket.socket(socket.AF_INET, socket.SOCK_STREAM, fileno=duplicate)
        except OSError:
            os.close(duplicate)
            return
        with candidate:
            if is_selected(candidate):
                candidate.shutdown(socket.SHUT_RDWR)
