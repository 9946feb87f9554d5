"""The queue of connections: all are served, those that ask for /healthz first."""

import asyncio
import socket
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

import pytest

from service.api.limits.connection_queue import SERVED_AT_ONCE, ConnectionQueue
from service.process.tally import Tally

OTHER = b"GET /api/v1/motors HTTP/1.1\r\n\r\n"
HEALTH = b"GET /healthz HTTP/1.1\r\n\r\n"


@contextmanager
def crowd(*first: bytes) -> Iterator[tuple[socket.socket, list[socket.socket]]]:
    """A listening socket, and clients that have connected and sent this, in this order."""
    with socket.create_server(("127.0.0.1", 0), backlog=1000) as listener, ExitStack() as held:
        clients = []
        for sent in first:
            client = held.enter_context(socket.create_connection(listener.getsockname()))
            client.sendall(sent)
            clients.append(client)
        yield listener, clients


async def served(listener: socket.socket, number: int, *, most: int = 1000) -> list[bytes]:
    """What clients had sent, in the order in which they were served."""
    order: list[bytes] = []
    done = asyncio.Event()

    async def serve(connection: socket.socket) -> None:
        with connection:
            try:
                order.append(connection.recv(100))
            except BlockingIOError:
                order.append(b"")
        if len(order) == number:
            done.set()

    queue = ConnectionQueue(listener, serve, most=most, tally=Tally("test"))
    async with asyncio.timeout(20):
        await done.wait()
    queue.close()
    return order


@pytest.mark.parametrize("most", [1000, 20])
def test_all_are_served_and_health_first(most: int) -> None:
    asked = [OTHER] * 300 + [HEALTH] + [OTHER] * 30
    if most == 20:
        asked = [OTHER] * 10 + [HEALTH] + [OTHER] * 300
    with crowd(*asked) as (listener, _):
        order = asyncio.run(served(listener, len(asked), most=most))
    assert sorted(order) == sorted(asked)
    assert order.index(HEALTH) < 2 * SERVED_AT_ONCE, "it is behind those of the first turn at most"


def test_who_has_sent_nothing_yet_keeps_nobody_waiting() -> None:
    asked = [b""] * 100 + [OTHER] * 10 + [HEALTH]
    with crowd(*asked) as (listener, _):
        order = asyncio.run(served(listener, len(asked)))
    assert order[0] == HEALTH
    assert order[1:11] == [OTHER] * 10
    assert order[11:] == [b""] * 100


def test_who_went_away_is_no_failure() -> None:
    with crowd(OTHER, OTHER, OTHER) as (listener, clients):
        clients[1].setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")
        clients[1].close()  # with a reset
        order = asyncio.run(served(listener, 2))
    assert order[:2] == [OTHER, OTHER]


def test_a_closed_queue_closes_those_that_wait() -> None:
    async def close_at_once(listener: socket.socket) -> None:
        async def serve(_connection: socket.socket) -> None:
            raise AssertionError("expected none to be served")

        queue = ConnectionQueue(listener, serve, most=1000, tally=Tally("test"))
        queue._accept()
        queue.close()
        await asyncio.sleep(0)

    with crowd(OTHER, b"") as (listener, clients):
        asyncio.run(close_at_once(listener))
        for client in clients:
            client.settimeout(20)
            with pytest.raises(ConnectionResetError) if client is clients[0] else ExitStack():
                assert client.recv(1) == b""
