"""Connections whose clients never associate: they would keep others out for ever.

libiec61850 serves few clients at a time, a connection counts from its first moment on, and the library waits
without end for the first octet.
"""

import socket
import struct
import threading
import time
from contextlib import suppress
from typing import Final

from mms.server.own_connections import connection_at, sockets

ASSOCIATED_OCTETS: Final = 64
"""So much or more is sent to a client that is associated; to one that only asked for transport it is 22."""

_SENT_AND_HEARD: Final = 120
"""Offset of tcpi_bytes_acked in struct tcp_info (linux/tcp.h)."""

_LOOKS: Final = 4
"""So often in the time that a client has."""


class SilentConnections:
    """Ends connections to one of our ports whose clients have not associated in time.

    Parameters
    ----------
    own : tuple of str and int
        Address and port at this end.
    limit_s : float
        Time that a client has [s].
    """

    def __init__(self, own: tuple[str, int], limit_s: float) -> None:
        self._own = own
        self._limit_s = limit_s
        self._since_s: dict[str, float] = {}
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="silent connections", daemon=True)

    def start(self) -> None:
        """Begin to look, on a thread of its own."""
        self._thread.start()

    def stop(self) -> None:
        """End that thread."""
        self._stopping.set()
        self._thread.join()

    def _run(self) -> None:
        while not self._stopping.wait(self._limit_s / _LOOKS):
            self._look(time.monotonic())

    def _look(self, now_s: float) -> None:
        silent: dict[str, float] = {}
        for descriptor, name in sockets().items():
            connection = connection_at(descriptor, self._own)
            if connection is None:
                continue
            with connection, suppress(OSError):  # its client may end it meanwhile
                if _heard_octets(connection) >= ASSOCIATED_OCTETS:
                    continue
                silent[name] = self._since_s.get(name, now_s)
                if now_s - silent[name] >= self._limit_s:
                    connection.shutdown(socket.SHUT_RDWR)
        self._since_s = silent


def _heard_octets(connection: socket.socket) -> int:
    """Return how much of what we sent the other end has acknowledged."""
    info = connection.getsockopt(socket.IPPROTO_TCP, socket.TCP_INFO, _SENT_AND_HEARD + 8)
    return int(struct.unpack_from("@Q", info, _SENT_AND_HEARD)[0])
