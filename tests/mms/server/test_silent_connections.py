"""Clients that connect and never associate are sent away; others stay, however quiet they are."""

import socket
from collections.abc import Iterator

import pytest

from mms import Client, FunctionalConstraint, MmsError, Server
from testing.ports import LOOPBACK, free_port
from testing.relays.model import MODEL_TEXT
from testing.waiting import eventually

TRANSPORT_ASKED = bytes.fromhex("0300001611e00000000100c0010dc2020001c1020001")
"""COTP connection request (ISO 8073)."""
LIMIT_S = 1.0


@pytest.fixture
def server() -> Iterator[Server]:
    with Server(MODEL_TEXT, port=free_port(), max_connections=2, association_timeout_s=LIMIT_S) as server:
        yield server


def reads(client: Client) -> bool:
    return client.read("T1PRO/GGIO1.Ind01.stVal", FunctionalConstraint.ST) is False


@pytest.mark.parametrize("first_words", [b"", b"\x03", TRANSPORT_ASKED])
def test_silent_clients_make_room(server: Server, first_words: bytes) -> None:
    with Client.connect(LOOPBACK, server.port) as quiet:
        with socket.create_connection((LOOPBACK, server.port), timeout=20) as mute:
            mute.sendall(first_words)
            answer = mute.recv(100) if first_words == TRANSPORT_ASKED else b""
            assert (len(answer) > 0) == (first_words == TRANSPORT_ASKED)
            assert mute.recv(1) == b"", "it is sent away"

        def is_another_served() -> bool:
            try:
                with Client.connect(LOOPBACK, server.port) as another:
                    return reads(another)
            except MmsError:
                return False

        assert eventually(is_another_served)
        assert reads(quiet), "who is associated stays, though it has said nothing for longer than the limit"


def test_connections_at_other_ports_are_left_alone(server: Server) -> None:
    with socket.create_server((LOOPBACK, 0)) as other, socket.create_connection(other.getsockname()) as mute:
        accepted, _ = other.accept()
        with accepted, socket.create_connection((LOOPBACK, server.port), timeout=20) as ended:
            assert ended.recv(1) == b""
            mute.sendall(b"x")
            assert accepted.recv(1) == b"x"
