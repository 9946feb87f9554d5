"""An end for what the MMS library would go on with for ever: a TLS handshake nobody answers, a list of names
of which more follows each time.

The library tries again and again, as fast as it can, and offers no way to stop it. What it does heed is the
end of the TCP connection, which the operating system lets any part of this process bring about.
"""

import os
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

_DESCRIPTORS: Final = Path("/proc/self/fd")


Chosen = Callable[[socket.socket], bool]


def between(*, own: tuple[str, int] | None = None, peer: tuple[str, int] | None = None) -> Chosen:
    """Chooses connections by the address and port of either end; None for any."""

    def chosen(connection: socket.socket) -> bool:
        ends = (connection.getsockname(), connection.getpeername())
        return own in (None, ends[0]) and peer in (None, ends[1])

    return chosen


@contextmanager
def limited(
    chosen: Chosen, limit_s: float, *, before: frozenset[str] | None = None
) -> Iterator[threading.Event]:
    """End those connections `chosen` that are made within the block and still stand when the limit is over.

    One like them that another thread made meanwhile goes with them. before: what `present` gave before they
    were made, for those that are older than the block. The event tells that the limit was over.
    """
    older = present() if before is None else before
    over = threading.Event()

    def end() -> None:
        over.set()
        for descriptor, name in _sockets().items():
            if name not in older:
                _end(descriptor, chosen)

    timer = threading.Timer(limit_s, end)
    timer.daemon = True
    timer.start()
    try:
        yield over
    finally:
        timer.cancel()


def present() -> frozenset[str]:
    """This process's sockets."""
    return frozenset(_sockets().values())


def _sockets() -> dict[int, str]:
    """Of this process: descriptor and, as "socket:[inode]", the one it stands for."""
    found = {}
    for entry in _DESCRIPTORS.iterdir():
        with suppress(OSError):  # closed meanwhile
            name = str(entry.readlink())
            if name.startswith("socket:"):
                found[int(entry.name)] = name
    return found


def _end(descriptor: int, chosen: Chosen) -> None:
    """Shut it down if it is chosen. Looked at in a duplicate, which nobody else closes."""
    with suppress(OSError):
        duplicate = os.dup(descriptor)
        try:
            candidate = socket.socket(socket.AF_INET, socket.SOCK_STREAM, fileno=duplicate)
        except OSError:
            os.close(duplicate)
            return
        with candidate:
            if chosen(candidate):
                candidate.shutdown(socket.SHUT_RDWR)
