"""The REST client against a service that misbehaves."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, HTTPServer
from threading import Thread

import pytest

from service.client.rest_client import ServiceClient, ServiceError

ANSWERS = {
    "/api/v1/text": (200, "text/plain", "hello"),
    "/api/v1/list": (200, "application/json", "[]"),
    "/api/v1/motors": (200, "application/json", json.dumps({"items": [{"name": "A"}], "next_cursor": "c"})),
    "/api/v1/motors?cursor=c": (200, "application/json", json.dumps({"items": [{"name": "B"}]})),
    "/api/v1/items": (200, "application/json", json.dumps({"items": None})),
    "/api/v1/problem": (404, "application/problem+json", json.dumps({"title": "?", "detail": "no motor X"})),
    "/api/v1/broken": (502, "text/html", "<h1>Bad gateway</h1>"),
}


class Misbehaving(BaseHTTPRequestHandler):
    def do_GET(self) -> None:
        status, kind, body = ANSWERS.get(self.path, (503, "text/plain", ""))
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body.encode())

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002 - the base class's name
        """Silence."""


@contextmanager
def answering() -> Iterator[ServiceClient]:
    with HTTPServer(("127.0.0.1", 0), Misbehaving) as server:
        thread = Thread(target=server.serve_forever, args=(0.01,))
        thread.start()
        try:
            with ServiceClient(f"http://127.0.0.1:{server.server_port}") as client:
                yield client
        finally:
            server.shutdown()
            thread.join()


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("/text", "expected JSON"),
        ("/list", "expected a JSON object"),
        ("/problem", "no motor X"),
        ("/broken", "HTTP status 502"),
    ],
)
def test_what_is_wrong_is_said(path: str, message: str) -> None:
    with answering() as client, pytest.raises(ServiceError, match=message):
        client.get(path)


def test_pages_are_followed() -> None:
    with answering() as client:
        assert [item["name"] for item in client.items("/motors")] == ["A", "B"]


def test_a_list_without_items_is_no_list() -> None:
    with answering() as client, pytest.raises(ServiceError, match="list of items"):
        list(client.items("/items"))


def test_a_service_that_is_not_ready() -> None:
    with answering() as client:
        assert not client.is_ready()


@pytest.mark.parametrize("url", ["nonsense", "127.0.0.1:8710", "ftp://127.0.0.1", "http://"])
def test_what_is_no_address_of_a_service(url: str) -> None:
    with pytest.raises(ServiceError, match="expected a URL such as"):
        ServiceClient(url)


def test_an_address_where_nobody_answers() -> None:
    with (
        ServiceClient("http://127.0.0.1:9") as client,
        pytest.raises(ServiceError, match="no service answers"),
    ):
        client.get("/motors")


@pytest.mark.parametrize(
    "url",
    [
        "http://mcc:Zx9@127.0.0.1:1",
        "http://mcc:Zx9@Zx9@127.0.0.1:1",
        "http://mcc:Zx9@Zx9:Zx9@127.0.0.1:1",
        "http://mcc:Zx9/Zx9@127.0.0.1:1",
        "mcc:Zx9@127.0.0.1",
        "ftp://mcc:Zx9@127.0.0.1",
    ],
)
def test_no_password_of_a_url_is_told(url: str) -> None:
    with pytest.raises(ServiceError) as refused, ServiceClient(url) as client:
        client.get("/motors")
    assert "Zx9" not in str(refused.value)
