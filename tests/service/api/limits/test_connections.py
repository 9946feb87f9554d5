"""Clients that keep the service waiting, seen from their sockets: a real server with short limits."""

import asyncio
import http.client
import json
import socket
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import AsyncIterator, Iterator, MutableMapping
from contextlib import ExitStack, asynccontextmanager, contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import httpx
import pytest
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response
from starlette.routing import Route

from service.api.limits.connections import ConnectionLimits
from service.api.server import ApiServer
from testing.waiting import eventually
from tests.service.api.serving import listening

LIMIT_S = 0.3
PATIENCE_S = 10.0
SHORT = ConnectionLimits(
    most=50, header_timeout_s=LIMIT_S, transfer_timeout_s=LIMIT_S, idle_timeout_s=LIMIT_S
)
PATIENT = ConnectionLimits(most=8, header_timeout_s=60, transfer_timeout_s=60, idle_timeout_s=60)

HOST = b"Host: 127.0.0.1\r\n"
HEALTH = b"GET /healthz HTTP/1.1\r\n" + HOST + b"\r\n"
POST = b"POST /read HTTP/1.1\r\n" + HOST + b"Content-Length: %d\r\n\r\n"
LARGE = b"x" * (32 << 20)


class Application:
    """Routes that answer at once, read a body, answer much, or wait until they are let go."""

    def __init__(self) -> None:
        self.waiting = threading.Semaphore(0)
        self.go_on = threading.Event()
        self.asgi = Starlette(
            routes=[
                Route("/healthz", self._healthz),
                Route("/read", self._read, methods=["POST"]),
                Route("/large", self._large),
                Route("/wait", self._wait),
                Route("/stall", self._stall),
            ]
        )

    async def _healthz(self, request: Request) -> Response:
        return PlainTextResponse("ok")

    async def _read(self, request: Request) -> Response:
        return PlainTextResponse(str(len(await request.body())))

    async def _large(self, request: Request) -> Response:
        return Response(LARGE)

    def _wait(self, request: Request) -> Response:
        self.waiting.release()
        self.go_on.wait(PATIENCE_S)
        return PlainTextResponse("waited")

    async def _stall(self, request: Request) -> Response:
        self.waiting.release()
        self.go_on.wait(PATIENCE_S)  # in the event loop, which serves nobody meanwhile
        return PlainTextResponse("stalled")


@pytest.fixture
def application() -> Iterator[Application]:
    made = Application()
    yield made
    made.go_on.set()


@contextmanager
def connected(port: int, first: bytes = b"") -> Iterator[socket.socket]:
    with socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S) as client:
        client.sendall(first)
        yield client


def until_closed(client: socket.socket, then: bytes = b"") -> bytes:
    """What the service sends until it closes the connection, to a client that goes on sending `then`."""
    received = b""
    deadline_s = time.monotonic() + PATIENCE_S
    client.settimeout(LIMIT_S / 10)
    while time.monotonic() < deadline_s:
        try:
            part = client.recv(1 << 16)
            if not part:
                return received
            received += part
        except TimeoutError:
            try:
                client.sendall(then)
            except OSError:
                return received
        except ConnectionResetError:
            return received
    raise AssertionError(f"the connection is still open after {PATIENCE_S} s")


@pytest.mark.parametrize(
    ("first", "then", "status"),
    [
        (b"", b"", b"408"),
        (b"GET /healthz HTTP/1.1\r\nHo", b"", b"408"),
        (b"GET /healthz HTTP/1.1\r\nX-Long: ", b"x", b"408"),
        (b"GET /healthz HTTP/1.1\r\n", b"X-More: 1\r\n", b"408"),
        (POST % 1000, b"", b"408"),
        (POST % 1000, b"x", b"408"),
        (POST.replace(b"/read", b"/nothing") % 1000, b"x", b"404"),
        (HEALTH + b"GET", b" ", b"200"),
        (HEALTH, b"", b"200"),
    ],
)
def test_no_client_keeps_the_service_waiting(
    application: Application,
    logs: list[MutableMapping[str, Any]],
    first: bytes,
    then: bytes,
    status: bytes,
) -> None:
    with listening(application.asgi, SHORT) as port, connected(port, first) as client:
        received = until_closed(client, then)
        assert received.startswith(b"HTTP/1.1 " + status)
        if status == b"408":
            assert b"application/problem+json" in received
    assert not [entry for entry in logs if entry["log_level"] == "error"]


def test_an_answer_that_nobody_takes_ends_the_connection(application: Application) -> None:
    with (
        listening(application.asgi, SHORT) as port,
        connected(port, HEALTH.replace(b"/healthz", b"/large")) as client,
    ):
        assert eventually(lambda: not _is_established(port, client.getsockname()[1]), PATIENCE_S)


def test_a_slow_but_steady_transfer_is_let_go_on(application: Application) -> None:
    body = b"x" * (200 << 10)
    with listening(application.asgi, SHORT) as port, connected(port, POST % len(body)) as client:
        begun_s = time.monotonic()
        for start in range(0, len(body), 1 << 14):
            client.sendall(body[start : start + (1 << 14)])
            time.sleep(LIMIT_S / 6)
        assert time.monotonic() - begun_s > LIMIT_S
        assert client.recv(1 << 16).endswith(str(len(body)).encode())


def test_waiting_connections_make_room_for_new_ones(
    application: Application, logs: list[MutableMapping[str, Any]]
) -> None:
    with listening(application.asgi, PATIENT) as port, ExitStack() as held:
        silent = [held.enter_context(connected(port, POST % 1000)) for _ in range(150)]
        assert eventually(lambda: sum(map(_is_open, silent)) <= PATIENT.most + 64, PATIENCE_S)
        for _ in range(20):
            assert httpx.get(f"http://127.0.0.1:{port}/healthz?again", trust_env=False).text == "ok"
        assert eventually(lambda: _ask_and_count(port, silent) <= PATIENT.most, PATIENCE_S)
    told = [entry for entry in logs if entry["event"] == "connections were closed or refused"]
    assert len(told) == 1, "one line a minute"
    assert told[0].keys() & {"displaced", "refused"}, "refused where those before it were not read yet"


def test_a_crowd_at_one_address_displaces_nobody_at_another(application: Application) -> None:
    """Also not a client that connected before all of them, and takes its time to ask."""
    with listening(application.asgi, PATIENT) as port, ExitStack() as held:
        other = held.enter_context(
            socket.create_connection(("127.0.0.1", port), PATIENCE_S, source_address=("127.0.0.2", 0))
        )
        crowd = [held.enter_context(connected(port, POST % 1000)) for _ in range(300)]
        assert eventually(lambda: sum(map(_is_open, crowd)) <= PATIENT.most + 64, PATIENCE_S)
        other.sendall(HEALTH)
        assert other.recv(1 << 16).startswith(b"HTTP/1.1 200")


def test_a_burst_of_requests_is_answered_to_the_last(application: Application) -> None:
    """None of these clients keeps the service waiting: it is the service that is behind."""
    with listening(application.asgi, replace(PATIENT, most=8)) as port, ExitStack() as held:
        held.enter_context(connected(port, HEALTH.replace(b"/healthz", b"/stall")))
        assert application.waiting.acquire(timeout=PATIENCE_S)
        burst = [held.enter_context(connected(port, HEALTH)) for _ in range(600)]
        application.go_on.set()
        answers = Counter(client.recv(1 << 16).partition(b"\r\n")[0] for client in burst)
    assert answers == {b"HTTP/1.1 200 OK": len(burst)}


def test_where_all_are_being_answered_health_alone_is_told(application: Application) -> None:
    with listening(application.asgi, PATIENT) as port, ExitStack() as held:
        asked = HEALTH.replace(b"/healthz", b"/wait")
        for _ in range(PATIENT.most):
            held.enter_context(connected(port, asked))
            assert application.waiting.acquire(timeout=PATIENCE_S)
        answer = httpx.get(f"http://127.0.0.1:{port}/large", trust_env=False)
        assert answer.status_code == 503
        assert answer.headers["content-type"] == "application/problem+json"
        assert int(answer.headers["retry-after"]) > 0
        assert answer.headers["connection"] == "close"
        with socket.create_connection(
            ("127.0.0.1", port), PATIENCE_S, source_address=("127.0.0.2", 0)
        ) as other:
            other.sendall(POST % 1 + b"x")
            assert other.recv(1 << 16).startswith(b"HTTP/1.1 200"), "it does not crowd the service"
        assert httpx.get(f"http://127.0.0.1:{port}/healthz", trust_env=False).status_code == 200
        application.go_on.set()
        assert eventually(
            lambda: httpx.get(f"http://127.0.0.1:{port}/large", trust_env=False).status_code == 200,
            PATIENCE_S,
        )


def test_who_connects_while_the_application_starts_is_answered(application: Application) -> None:
    starting, go_on = threading.Event(), threading.Event()

    @asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        starting.set()
        await asyncio.to_thread(go_on.wait, PATIENCE_S)
        yield

    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        server = ApiServer(Starlette(routes=application.asgi.routes, lifespan=lifespan), PATIENT)
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        assert starting.wait(PATIENCE_S)
        try:
            with connected(listener.getsockname()[1], HEALTH) as client:
                go_on.set()
                assert client.recv(1 << 16).startswith(b"HTTP/1.1 200")
        finally:
            go_on.set()
            server.should_exit = True
            thread.join(PATIENCE_S)


def test_a_body_that_nobody_reads_has_an_end(application: Application) -> None:
    """The route answers at once, and the client goes on sending."""
    chunk = b"10000\r\n" + b"x" * 0x10000 + b"\r\n"
    with (
        listening(application.asgi, PATIENT) as port,
        connected(port, HEALTH.removesuffix(b"\r\n") + b"Transfer-Encoding: chunked\r\n\r\n") as client,
    ):
        assert client.recv(1 << 16).startswith(b"HTTP/1.1 200")
        with pytest.raises(ConnectionError):
            client.sendall(chunk * 1000)


@pytest.mark.parametrize(
    "request_line_and_lengths",
    [
        b"POST /read HTTP/1.1\r\nContent-Length: 4\r\nTransfer-Encoding: chunked\r\n",
        b"POST /read HTTP/1.1\r\nTransfer-Encoding: chunked\r\nContent-Length: 4\r\n",
        b"POST /read HTTP/1.0\r\nTransfer-Encoding: chunked\r\n",
        b"POST /read HTTP/1.1\r\nContent-Length: 4\r\nContent-Length: 5\r\n",
    ],
)
def test_a_request_whose_end_is_told_twice_is_refused(
    application: Application, request_line_and_lengths: bytes
) -> None:
    smuggled = b"0\r\n\r\n" + HEALTH
    with (
        listening(application.asgi, PATIENT) as port,
        connected(port, request_line_and_lengths + HOST + b"\r\n" + smuggled) as client,
    ):
        received = until_closed(client)
    assert received.startswith(b"HTTP/1.1 400")
    assert b"application/problem+json" in received
    assert received.count(b"HTTP/1.1 ") == 1, "what follows is not taken for a request"


def test_what_is_no_http_is_one_line_a_minute(
    application: Application, logs: list[MutableMapping[str, Any]], caplog: pytest.LogCaptureFixture
) -> None:
    with listening(application.asgi, PATIENT) as port:
        for _ in range(30):
            with connected(port, b"\x16\x03\x01\r\n\r\n") as client:
                received = until_closed(client)
                assert received.startswith(b"HTTP/1.1 400")
                json.loads(received.partition(b"\r\n\r\n")[2])
    assert len([entry for entry in logs if "invalid_requests" in entry]) == 1
    assert not [record for record in caplog.records if record.levelname == "WARNING"]


SERVER = """
import resource, socket
from service.api.limits.connections import ConnectionLimits
from service.api.server import ApiServer
from service.process.logs import configure_logging
from tests.service.api.limits.test_connections import Application

configure_logging("server")
resource.setrlimit(resource.RLIMIT_NOFILE, (60, 60))
listener = socket.create_server(("127.0.0.1", 0))
print(listener.getsockname()[1], flush=True)
ApiServer(Application().asgi, ConnectionLimits(1000, 0.5, 0.5, 0.5)).run(sockets=[listener])
"""


def test_connections_that_cannot_be_accepted_are_one_line_a_minute(tmp_path: Path) -> None:
    """More may come than this process has descriptors for."""
    log = tmp_path / "log"
    with (
        log.open("wb") as sink,
        subprocess.Popen([sys.executable, "-c", SERVER], stdout=subprocess.PIPE, stderr=sink) as server,
    ):
        try:
            assert server.stdout is not None
            port = int(server.stdout.readline())
            assert _is_healthy(port), "the queue of connections is short until the server has started"
            with ExitStack() as held:
                for _ in range(150):
                    held.enter_context(connected(port))
                assert eventually(lambda: b"not_accepted" in log.read_bytes(), PATIENCE_S)
                assert eventually(lambda: _is_healthy(port), PATIENCE_S), "after the silent ones are closed"
        finally:
            server.terminate()
            server.wait(PATIENCE_S)
    lines = log.read_text().splitlines()
    assert len([line for line in lines if "not_accepted" in line]) == 1
    assert not [line for line in lines if "Traceback" in line or "socket.accept" in line]


def _is_healthy(port: int) -> bool:
    client = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
    try:
        client.request("GET", "/healthz")
        return client.getresponse().status == http.client.OK
    except (OSError, http.client.HTTPException):
        return False
    finally:
        client.close()


def _is_open(client: socket.socket) -> bool:
    client.settimeout(0)
    try:
        client.recv(1, socket.MSG_PEEK)
    except BlockingIOError:
        return True
    except OSError:
        return False
    return False


def _ask_and_count(port: int, clients: list[socket.socket]) -> int:
    """How many are open after another new connection, which the process that accepts does not answer."""
    assert httpx.get(f"http://127.0.0.1:{port}/healthz?again", trust_env=False).text == "ok"
    return sum(map(_is_open, clients))


def _is_established(server: int, client: int) -> bool:
    """Whether the server's end of a connection is still open."""
    for line in Path("/proc/net/tcp").read_text().splitlines()[1:]:
        _, local, remote, state, *_ = line.split()
        if (int(local.partition(":")[2], 16), int(remote.partition(":")[2], 16)) == (server, client):
            return state == "01"
    return False
