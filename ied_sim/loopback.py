"""Addresses of this machine's own, for servers that stand behind a front."""

import socket

from scl import Address

HOST = "127.0.0.1"


def free_address() -> Address:
    """Where nobody listens. Another program may be faster to take it; the server then says so."""
    with socket.socket() as probe:
        probe.bind((HOST, 0))
        port: int = probe.getsockname()[1]
        return Address(HOST, port)
