"""Keeps out requests without one certain end, and those beyond the limit of connections."""

from http import HTTPStatus

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.api.limits.connections import OVERLOADED, OpenConnections
from service.api.problems import RETRY_AFTER_S, problem_response

ALWAYS_ANSWERED = "/healthz"

CLOSING = {"Connection": "close"}


class ConnectionGuard:
    """ASGI middleware, in front of all others."""

    def __init__(self, app: ASGIApp, connections: OpenConnections) -> None:
        self._app = app
        self._connections = connections
        self._under_way: set[_Exchange] = set()

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
        elif scope["path"] != ALWAYS_ANSWERED and self._is_refused(scope):
            self._connections.tally.add("refused")
            headers = CLOSING | {"Retry-After": str(RETRY_AFTER_S)}
            refusal = problem_response(
                scope["path"], HTTPStatus.SERVICE_UNAVAILABLE, OVERLOADED, headers=headers
            )
            await refusal(scope, receive, send)
        else:
            exchange = _Exchange(scope, receive, send)
            self._under_way.add(exchange)
            try:
                await self._app(scope, exchange.receive, exchange.send)
            finally:
                self._under_way.discard(exchange)

    def _is_refused(self, scope: Scope) -> bool:
        """Tell whether more requests are being answered than there may be connections.

        A request is answered to its end, also when its client is gone. One that waits for its client costs
        little, and does not count. One whose answer has not begun yet counts. An address that has no more
        than an equal share of the connections is answered all the same.
        """
        requests = len(self._connections.tasks)
        most = self._connections.limits.most
        if requests <= most or requests - sum(map(_Exchange.waits_for_client, self._under_way)) <= most:
            return False
        return self._connections.is_crowded(scope["client"][0] if scope["client"] else "")


class _Exchange:
    """A request and its answer."""

    def __init__(self, scope: Scope, receive: Receive, send: Send) -> None:
        headers = dict(scope["headers"])
        self._receive = receive
        self._send = send
        self._has_more_body = b"transfer-encoding" in headers or headers.get(b"content-length", b"0") != b"0"
        self._is_sending = False

    def waits_for_client(self) -> bool:
        """Tell whether the rest of the body is still to come, or the client is to take the answer."""
        return self._has_more_body or self._is_sending

    async def receive(self) -> Message:
        message = await self._receive()
        self._has_more_body = message["type"] == "http.request" and message.get("more_body", False)
        return message

    async def send(self, message: Message) -> None:
        self._is_sending = True
        try:
            await self._send(message)
        finally:
            self._is_sending = False


def _is_ambiguous(scope: Scope) -> bool:
    """Tell whether a proxy may see another end of the request than we do (RFC 9112 section 6.1)."""
    names = {name for name, _ in scope["headers"]}
    return b"transfer-encoding" in names and (b"content-length" in names or scope["http_version"] != "1.1")
