"""Associating, losing the association, and giving it up."""

import logging
import socket
import threading
import time

import pytest

from mms import Client, ConnectFailed, ConnectionLost, FunctionalConstraint, Server, Timeout
from testing.ports import LOOPBACK, free_port
from testing.relays.serving import Relaying, RelayProcess, mute_server, start_relay
from testing.waiting import eventually

IND01 = "T1PRO/GGIO1.Ind01.stVal"


def test_a_refused_port_is_named() -> None:
    port = free_port()
    with pytest.raises(ConnectFailed, match=rf"127\.0\.0\.1:{port}: connect: the connection was rejected"):
        Client.connect(LOOPBACK, port)


def test_a_mute_server_fails_within_the_connect_timeout() -> None:
    with mute_server() as port:
        started_s = time.monotonic()
        with pytest.raises(ConnectFailed):
            Client.connect(LOOPBACK, port, connect_timeout_s=0.5)
        assert time.monotonic() - started_s < 3


@pytest.mark.parametrize("host", ["no such host", "relay.invalid", "x" * 300])
def test_an_unknown_name_is_a_failed_connect(host: str) -> None:
    with pytest.raises(ConnectFailed, match="cannot resolve"):
        Client.connect(host, 102)


NOBODY = "255.255.255.255"
"""No connection can be made to it, and the system says so at once."""


def named(monkeypatch: pytest.MonkeyPatch, *addresses: str) -> None:
    """Have every name stand for these addresses."""
    found = [(socket.AF_INET, socket.SOCK_STREAM, 6, "", (address, 0)) for address in addresses]
    monkeypatch.setattr(socket, "getaddrinfo", lambda *_: found)


def test_each_address_of_a_name_is_tried(monkeypatch: pytest.MonkeyPatch, relay: Server) -> None:
    named(monkeypatch, NOBODY, LOOPBACK)
    with Client.connect("relay-a1", relay.port) as client:
        assert client.read(IND01, FunctionalConstraint.ST) is False


def test_a_silent_address_leaves_time_for_the_next(monkeypatch: pytest.MonkeyPatch, relay: Server) -> None:
    with socket.create_server(("127.0.0.2", relay.port)):
        named(monkeypatch, "127.0.0.2", LOOPBACK)
        with Client.connect("relay-a1", relay.port, connect_timeout_s=4.0) as client:
            assert client.read(IND01, FunctionalConstraint.ST) is False


def test_a_name_none_of_whose_addresses_answers(monkeypatch: pytest.MonkeyPatch) -> None:
    named(monkeypatch, NOBODY, LOOPBACK)
    port = free_port()
    with pytest.raises(ConnectFailed, match=rf"relay-a1:{port}: .*addresses {NOBODY}, {LOOPBACK}"):
        Client.connect("relay-a1", port)


@pytest.mark.parametrize("port", [0, -1, 65536])
def test_a_port_that_is_none_is_a_failed_connect(port: int) -> None:
    with pytest.raises(ConnectFailed, match="not a TCP port"):
        Client.connect(LOOPBACK, port)


def test_a_relay_without_a_session_left_is_a_failed_connect() -> None:
    with (
        start_relay(max_connections=1) as relay,
        Client.connect(LOOPBACK, relay.port),
        pytest.raises(ConnectFailed),
    ):
        Client.connect(LOOPBACK, relay.port, connect_timeout_s=1.0)


def test_an_association_lost_right_after_the_connect_is_tried_again(relay: Server) -> None:
    """The library's connect race, provoked: cut at the first request after COTP and initiate."""
    proxy = Relaying(relay.port, cuts=2, after_messages=2)
    try:
        with Client.connect(LOOPBACK, proxy.port) as client:
            assert client.read(IND01, FunctionalConstraint.ST) is False
        assert proxy.accepted == 3
    finally:
        proxy.close()


def test_a_relay_that_ends_every_association_is_a_failed_connect(relay: Server) -> None:
    proxy = Relaying(relay.port, cuts=1000, after_messages=2)
    try:
        with pytest.raises(ConnectFailed, match="ends every association"):
            Client.connect(LOOPBACK, proxy.port)
    finally:
        proxy.close()


def test_closing_ends_the_session_and_is_harmless_twice(relay: Server) -> None:
    client = Client.connect(LOOPBACK, relay.port)
    states = [client.is_open]
    assert client.host == f"127.0.0.1:{relay.port}"
    client.close()
    client.close()
    states.append(client.is_open)
    assert states == [True, False]
    assert client.wait_closed(0)
    assert eventually(lambda: relay.connections == 0)
    with pytest.raises(ConnectionLost, match="the connection is closed"):
        client.read(IND01, FunctionalConstraint.ST)


def test_a_killed_relay_is_noticed_by_a_waiting_thread(relay_process: RelayProcess) -> None:
    told = threading.Event()
    with Client.connect(LOOPBACK, relay_process.port, on_closed=told.set) as client:
        assert not client.wait_closed(0)
        relay_process.kill()
        assert client.wait_closed(10)
        assert told.wait(1)
        assert not client.is_open
        with pytest.raises(ConnectionLost):
            client.logical_devices()


def test_a_stopped_server_is_noticed(relay: Server) -> None:
    with Client.connect(LOOPBACK, relay.port) as client:
        relay.stop()
        assert client.wait_closed(10)


def test_the_closed_notice_is_given_once(relay: Server) -> None:
    notices: list[int] = []
    client = Client.connect(LOOPBACK, relay.port, on_closed=lambda: notices.append(1))
    client.close()
    relay.stop()
    assert notices == [1]


def test_a_frozen_relay_times_out_and_may_come_back(relay_process: RelayProcess) -> None:
    with Client.connect(LOOPBACK, relay_process.port, request_timeout_s=0.5) as client:
        relay_process.freeze()
        with pytest.raises(Timeout, match="no answer in time"):
            client.read(IND01, FunctionalConstraint.ST)
        assert client.is_open, "a frozen relay ends nothing"
        relay_process.thaw()
        assert eventually(lambda: client.read(IND01, FunctionalConstraint.ST) is False)


def test_a_frozen_relay_does_not_hold_up_closing(relay_process: RelayProcess) -> None:
    client = Client.connect(LOOPBACK, relay_process.port, request_timeout_s=0.5)
    relay_process.freeze()
    started_s = time.monotonic()
    client.close()
    assert time.monotonic() - started_s < 5


def test_closing_waits_for_another_threads_request(relay_process: RelayProcess) -> None:
    client = Client.connect(LOOPBACK, relay_process.port, request_timeout_s=1.0)
    relay_process.freeze()
    outcome: list[Exception] = []

    def read() -> None:
        try:
            client.read(IND01, FunctionalConstraint.ST)
        except (Timeout, ConnectionLost) as error:
            outcome.append(error)

    reader = threading.Thread(target=read)
    reader.start()
    assert eventually(lambda: reader.is_alive())
    client.close()
    reader.join(10)
    assert len(outcome) == 1


def test_threads_share_a_client(client: Client) -> None:
    def read_often() -> None:
        for _ in range(50):
            results.append(client.read(IND01, FunctionalConstraint.ST))

    results: list[object] = []
    threads = [threading.Thread(target=read_often) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert results == [False] * 400


def test_an_exception_in_the_closed_callback_is_logged(
    relay: Server, caplog: pytest.LogCaptureFixture
) -> None:
    def fail() -> None:
        raise ValueError("no luck")

    client = Client.connect(LOOPBACK, relay.port, on_closed=fail)
    with caplog.at_level(logging.ERROR, logger="mms"):
        relay.stop()
        assert client.wait_closed(10)
        assert eventually(lambda: "no luck" in caplog.text)
    client.close()


def test_requests_from_a_callback_are_refused(relay: Server) -> None:
    refused: list[str] = []

    def misuse() -> None:
        for attempt in (client.logical_devices, client.close):
            try:
                attempt()
            except RuntimeError as error:
                refused.append(str(error))

    client = Client.connect(LOOPBACK, relay.port, on_closed=misuse)
    relay.stop()
    assert client.wait_closed(10)
    assert eventually(lambda: len(refused) == 2)
    client.close()


def test_garbage_for_an_answer_is_a_failed_connect() -> None:
    with socket.create_server((LOOPBACK, 0)) as listener:

        def answer() -> None:
            connection, _ = listener.accept()
            with connection:
                connection.recv(1000)
                connection.sendall(b"\x03\x00\x00\x0b\x06\xd0" + b"\xff" * 100)

        threading.Thread(target=answer, daemon=True).start()
        with pytest.raises(ConnectFailed):
            Client.connect(LOOPBACK, listener.getsockname()[1], connect_timeout_s=1.0)
