"""What the application answers to GET /healthz, taken once: it never changes while the service runs."""

from http import HTTPStatus

from starlette.types import ASGIApp, Message, Scope

HOST = b"localhost"


async def health_answer(app: ASGIApp) -> bytes:
    """Return the answer without its date, on a connection that is closed then; b"" where it is no 200."""
    sent: list[Message] = []

    async def receive() -> Message:
        return {"type": "http.request", "body": b"", "more_body": False}

    async def send(message: Message) -> None:
        sent.append(message)

    scope: Scope = {
        "type": "http",
        "asgi": {"version": "3.0", "spec_version": "2.3"},
        "http_version": "1.1",
        "method": "GET",
        "scheme": "http",
        "path": "/healthz",
        "raw_path": b"/healthz",
        "query_string": b"",
        "root_path": "",
        "headers": [(b"host", HOST)],
        "client": ("127.0.0.1", 0),
        "server": ("127.0.0.1", 0),
        "state": {},
    }
    await app(scope, receive, send)
    start, *bodies = sent
    if start["status"] != HTTPStatus.OK:
        return b""
    headers = b"".join(b"%s: %s\r\n" % header for header in start["headers"])
    body = b"".join(message.get("body", b"") for message in bodies)
    return b"HTTP/1.1 200 OK\r\n%sconnection: close\r\n\r\n%s" % (headers, body)
