"""Addresses of this machine's own, for servers that stand behind a front."""

import socket

from scl import Address

HOST = "127.0.0.2"
"""Not 127.0.0.1: a port that is free there may be one that another relay is about to listen at."""


class ReservedAddress:
    """A port nobody else is given while it is reserved; a server that reuses addresses can listen there."""

    def __init__(self) -> None:
        self._socket = socket.socket()
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self._socket.bind((HOST, 0))
        port: int = self._socket.getsockname()[1]
        self.address = Address(HOST, port)

    def release(self) -> None:
        self._socket.close()
