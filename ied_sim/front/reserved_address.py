"""Addresses on the loopback interface for servers that stand behind a proxy."""

import socket

from scl import Address

HOST = "127.0.0.2"
"""An address other than 127.0.0.1, where a free port may be one that another relay is about to listen at."""


class ReservedAddress:
    """A port that nobody else is given while it is reserved.

    A server that reuses addresses can listen there.
    """

    def __init__(self) -> None:
        self._socket = socket.socket()
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self._socket.bind((HOST, 0))
        port: int = self._socket.getsockname()[1]
        self.address = Address(HOST, port)

    def release(self) -> None:
        """Give the port back."""
        self._socket.close()
