"""The queue of connections: all are served, and /healthz also while the event loop stands still."""

import asyncio
import os
import signal
import socket
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest

from service.api.limits.connection_queue import ConnectionQueue
from service.process.tally import Tally
from testing.service.processes import descendants

OTHER = b"GET /api/v1/motors HTTP/1.1\r\n\r\n"
HEALTH = b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n"
ANSWER = b"HTTP/1.1 200 OK\r\ncontent-length: 2\r\n\r\nok"
PATIENCE_S = 20.0


@contextmanager
def crowd(*first: bytes) -> Iterator[tuple[socket.socket, list[socket.socket]]]:
    """A listening socket, and clients that have connected and sent this, in this order."""
    with socket.create_server(("127.0.0.1", 0), backlog=1000) as listener, ExitStack() as held:
        clients = []
        for sent in first:
            client = held.enter_context(socket.create_connection(listener.getsockname(), timeout=PATIENCE_S))
            client.sendall(sent)
            clients.append(client)
        yield listener, clients


async def served(
    listener: socket.socket,
    number: int,
    *,
    most: int = 1000,
    meanwhile: Callable[[ConnectionQueue], None] = ConnectionQueue.sign_of_life,
) -> list[bytes]:
    """What clients had sent, in the order in which they were served; meanwhile: done before any is."""
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

    queue = ConnectionQueue(listener, serve, most=most, tally=Tally("test"), health=ANSWER)
    try:
        meanwhile(queue)
        async with asyncio.timeout(PATIENCE_S):
            await done.wait()
    finally:
        queue.close()
    return order


@pytest.mark.parametrize("most", [1000, 20])
def test_all_are_served(most: int) -> None:
    asked = [OTHER] * 300
    with crowd(*asked) as (listener, _):
        assert asyncio.run(served(listener, len(asked), most=most)) == asked


def test_healthz_is_answered_behind_a_crowd_while_the_event_loop_stands_still() -> None:
    asked = [OTHER] * 300 + [b""] * 100 + [HEALTH, HEALTH.replace(b"GET", b"HEAD")]
    answers: list[bytes] = []

    with crowd(*asked) as (listener, clients):

        def wait_for_answers(_: ConnectionQueue) -> None:
            answers.extend(client.recv(1000) for client in clients[-2:])  # blocks the event loop

        order = asyncio.run(served(listener, 400, meanwhile=wait_for_answers))
    assert order == [OTHER] * 300 + [b""] * 100, "who has sent nothing keeps nobody waiting"
    head, _, body = answers[0].partition(b"\r\n\r\n")
    assert head.startswith(b"HTTP/1.1 200 OK\r\ndate: ")
    assert body == b"ok"
    assert answers[1].startswith(b"HTTP/1.1 200 OK\r\n")
    assert answers[1].endswith(b"content-length: 2\r\n\r\n"), "HEAD has no body"


@pytest.mark.parametrize(
    "request_",
    [
        HEALTH.replace(b"\r\n\r\n", b"\r\nOrigin: https://evil.example\r\n\r\n"),
        HEALTH.replace(b"\r\n\r\n", b"\r\nContent-Length: 3\r\n\r\nabc"),
        HEALTH.replace(b"\r\n\r\n", b"\r\nHost: other\r\n\r\n"),
        HEALTH + HEALTH,
        HEALTH[:-2],
        HEALTH.replace(b"healthz", b"healthz/"),
        HEALTH.replace(b"GET", b"PATCH"),
        b"GET /healthz HTTP/1.1\r\n\r\n",
    ],
)
def test_what_is_no_plain_question_is_for_the_service_to_answer(request_: bytes) -> None:
    with crowd(request_) as (listener, _):
        assert asyncio.run(served(listener, 1)) == [request_[:100]]


def test_who_went_away_is_no_failure() -> None:
    with crowd(OTHER, OTHER, OTHER) as (listener, clients):
        clients[1].setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")
        clients[1].close()  # with a reset
        assert asyncio.run(served(listener, 2))[:2] == [OTHER, OTHER]


def test_a_process_that_was_killed_is_started_again() -> None:
    before = set(descendants(os.getpid()))

    def kill(_: ConnectionQueue) -> None:
        (acceptor,) = set(descendants(os.getpid())) - before
        os.kill(acceptor, signal.SIGKILL)

    with socket.create_server(("127.0.0.1", 0)) as listener, ExitStack() as held:

        def kill_and_connect(queue: ConnectionQueue) -> None:
            kill(queue)
            client = held.enter_context(socket.create_connection(listener.getsockname()))
            client.sendall(OTHER)

        assert asyncio.run(served(listener, 1, meanwhile=kill_and_connect)) == [OTHER]


def test_a_closed_queue_leaves_no_process_and_closes_those_that_wait() -> None:
    before = set(descendants(os.getpid()))

    async def close_at_once(listener: socket.socket, asked: socket.socket) -> None:
        async def serve(_connection: socket.socket) -> None:
            raise AssertionError("expected none to be served")

        queue = ConnectionQueue(listener, serve, most=1000, tally=Tally("test"), health=ANSWER)
        asked.recv(1000)  # all that came before it are accepted
        queue.close()
        await asyncio.sleep(0)

    with crowd(OTHER, b"", HEALTH) as (listener, clients):
        asyncio.run(close_at_once(listener, clients[2]))
        for client in clients[:2]:
            with pytest.raises(ConnectionResetError) if client is clients[0] else ExitStack():
                assert client.recv(1) == b""
    assert set(descendants(os.getpid())) == before


def test_the_process_has_no_variable_and_no_file_of_the_service(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MCC_SECRET", "of the service")
    before = set(descendants(os.getpid()))
    seen: list[str] = []

    def look(_: ConnectionQueue) -> None:
        (acceptor,) = set(descendants(os.getpid())) - before
        process = Path(f"/proc/{acceptor}")
        seen.append((process / "environ").read_text())
        seen.append(" ".join(str(each.readlink()) for each in (process / "fd").iterdir()))

    with (
        socket.create_server(("127.0.0.1", 0)) as listener,
        socket.create_connection(listener.getsockname()) as client,
    ):
        client.sendall(OTHER)
        asyncio.run(served(listener, 1, meanwhile=look))
    environment, files = seen
    assert "MCC_SECRET" not in environment
    assert ".sqlite" not in files
