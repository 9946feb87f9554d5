"""A limit of time for the TLS handshake of a client, which the MMS library waits for without end.

The library offers no way to stop waiting, but it notices the end of the TCP connection, and the operating
system lets any part of this process shut a connection down.
"""

import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from mms.server.own_connections import connection_at, sockets


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
    older = frozenset(sockets().values())

    def end() -> None:
        for descriptor, name in sockets().items():
            if name not in older:
                _shut_down(descriptor, own)

    timer = threading.Timer(limit_s, end)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def _shut_down(descriptor: int, own: tuple[str, int]) -> None:
    """Shut a connection down if it is at our port."""
    connection = connection_at(descriptor, own)
    if connection is not None:
        with connection, suppress(OSError):
            connection.shutdown(socket.SHUT_RDWR)
