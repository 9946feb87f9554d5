"""The proxy of the links ends quietly, with connections that stand and others that just come."""

import logging
import socket
from contextlib import ExitStack

import pytest

from scl import Address
from testing.ports import LOOPBACK, free_port
from testing.relays.serving import mute_server
from testing.tcp_proxy import Proxy
from testing.waiting import wait_until

CLIENTS = 5


def test_it_closes_without_a_traceback(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.WARNING)
    seen = Address(LOOPBACK, free_port())
    with (
        ExitStack() as clients,
        mute_server() as port,
        Proxy({"R1": (Address(LOOPBACK, port), seen)}) as proxy,
    ):
        for _ in range(CLIENTS):
            clients.enter_context(socket.create_connection((seen.host, seen.port)))
        wait_until(lambda: proxy.links["R1"].connections == CLIENTS, "the connections")
        proxy.freeze("R1", on=True)
        for _ in range(CLIENTS):
            clients.enter_context(socket.create_connection((seen.host, seen.port))).sendall(b"request")
    assert [record.getMessage() for record in caplog.records] == []
