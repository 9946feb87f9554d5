"""What the application answers to GET /healthz, taken once: it never changes while the service runs."""

from http import HTTPStatus
from typing import Final

from httpx import ASGITransport, AsyncClient
from starlette.types import ASGIApp

ANYBODY: Final = "http://localhost"


async def health_answer(app: ASGIApp) -> bytes:
    """Return the answer without its date, on a connection that is closed then; b"" where it is no 200."""
    async with AsyncClient(transport=ASGITransport(app), base_url=ANYBODY) as client:
        answer = await client.get("/healthz", headers={"accept-encoding": "identity"})
    if answer.status_code != HTTPStatus.OK:
        return b""
    headers = b"".join(b"%s: %s\r\n" % header for header in answer.headers.raw)
    return b"HTTP/1.1 200 OK\r\n%sconnection: close\r\n\r\n%s" % (headers, answer.content)
