"""Keeps out requests without one certain end, and those beyond the limit of connections."""

from http import HTTPStatus

from starlette.types import ASGIApp, Receive, Scope, Send

from service.api.limits.connections import OVERLOADED, OpenConnections
from service.api.problems import RETRY_AFTER_S, problem_response

ALWAYS_ANSWERED = "/healthz"

CLOSING = {"Connection": "close"}


class ConnectionGuard:
    """ASGI middleware, in front of all others."""

    def __init__(self, app: ASGIApp, connections: OpenConnections) -> None:
        self._app = app
        self._connections = connections

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
        elif _is_ambiguous(scope):
            self._connections.tally.add("invalid_requests")
            detail = (
                "expected Content-Length or Transfer-Encoding (HTTP/1.1), found a length that is told twice"
            )
            refusal = problem_response(scope["path"], HTTPStatus.BAD_REQUEST, detail, headers=CLOSING)
            await refusal(scope, receive, send)
        elif scope["path"] != ALWAYS_ANSWERED and self._connections.is_overloaded():
            self._connections.tally.add("refused")
            headers = CLOSING | {"Retry-After": str(RETRY_AFTER_S)}
            refusal = problem_response(
                scope["path"], HTTPStatus.SERVICE_UNAVAILABLE, OVERLOADED, headers=headers
            )
            await refusal(scope, receive, send)
        else:
            await self._app(scope, receive, send)


def _is_ambiguous(scope: Scope) -> bool:
    """Tell whether a proxy may see another end of the request than we do (RFC 9112 section 6.1)."""
    names = {name for name, _ in scope["headers"]}
    return b"transfer-encoding" in names and (b"content-length" in names or scope["http_version"] != "1.1")
