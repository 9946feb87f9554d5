"""Bounds the body of every request, also where the route reads none.

Routes that take files have the limit of the settings (max_upload_bytes), and few of them at once, because the
files lie in the temporary folder meanwhile; they take forms with files only. Some have a rule of their own: a
relay's report as text, a picture. All others take small JSON documents, or nothing. Bodies other than files
are read here to the end, before the route begins.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from http import HTTPStatus
from typing import Final, NoReturn

import anyio
from starlette.datastructures import Headers
from starlette.exceptions import HTTPException
from starlette.routing import compile_path
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.api.limits.arrivals import Arrivals
from service.api.problems import BusyError, busy_response, problem_response

MAX_JSON_BYTES = 8 * 1024
"""More than the largest document that a route takes, a baseline of a hundred recordings with its reason."""

MAX_REPORT_BYTES = 256 * 1024
"""More than the text in which a relay tells its latest starts."""

UPLOAD_TYPE = "multipart/form-data"
REPORT_TYPE = "text/plain"

DISCARDED_BYTES = 1 << 20
DISCARDING_S = 1.0
"""So much of a refused body is thrown away, so that a client that still sends it gets to see the answer."""

Route = tuple[str, str]
"""Method and path."""


@dataclass(frozen=True, slots=True)
class BodyRule:
    """What a route takes that is no small JSON document: one media type, and so many bytes."""

    media_type: str
    most_bytes: int


REPORT: Final = BodyRule(REPORT_TYPE, MAX_REPORT_BYTES)
REPORT_IN_FORM: Final = BodyRule(UPLOAD_TYPE, MAX_REPORT_BYTES)


class BodyLimits:
    """ASGI middleware.

    upload_routes: those that take files of up to `max_upload_bytes`.
    body_rules: of those that take something else, by their paths with parameters in braces.
    """

    def __init__(
        self,
        app: ASGIApp,
        *,
        upload_routes: frozenset[Route],
        body_rules: Mapping[Route, BodyRule],
        max_upload_bytes: int,
        arrivals: Arrivals,
    ) -> None:
        self._app = app
        self._upload_routes = upload_routes
        self._rules = [(method, compile_path(path)[0], rule) for (method, path), rule in body_rules.items()]
        self._max_upload_bytes = max_upload_bytes
        self._arrivals = arrivals

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        is_upload = (scope["method"], scope["path"]) in self._upload_routes
        rule = self._rule(scope)
        exchange = _Exchange(receive, send, *self._limit(rule, is_upload=is_upload))
        headers = Headers(scope=scope)
        try:
            exchange.check_length(headers)
            if is_upload:
                exchange.check_type(headers, UPLOAD_TYPE)
                await self._upload(scope, exchange)
                return
            if rule is not None:
                exchange.check_type(headers, rule.media_type)
            if await exchange.read_ahead():
                await self._app(scope, exchange.receive, exchange.send)
        except _RefusalError as error:
            await problem_response(scope["path"], error.status_code, error.detail, headers=error.headers)(
                scope, exchange.receive, exchange.send
            )

    async def _upload(self, scope: Scope, exchange: "_Exchange") -> None:
        try:
            async with self._arrivals.arriving(exchange.receive) as receive:
                await self._app(scope, receive, exchange.send)
        except BusyError as error:
            await busy_response(scope["path"], str(error))(scope, exchange.receive, exchange.send)

    def _rule(self, scope: Scope) -> BodyRule | None:
        """Return the rule of the route; None where it has none of its own."""
        for method, path, rule in self._rules:
            if scope["method"] == method and path.match(scope["path"]):
                return rule
        return None

    def _limit(self, rule: BodyRule | None, *, is_upload: bool) -> tuple[int, str]:
        if is_upload:
            return self._max_upload_bytes, "; see max_upload_bytes in docs/reference/settings.md"
        return MAX_JSON_BYTES if rule is None else rule.most_bytes, ""


def document(operations: Mapping[str, Mapping[str, dict[str, object]]], limits: Mapping[Route, int]) -> None:
    """Write the limit into each operation of an OpenAPI document (path, method) that has a body."""
    for path, methods in operations.items():
        for method, operation in methods.items():
            if "requestBody" in operation:
                operation["x-max-body-bytes"] = limits.get((method.upper(), path), MAX_JSON_BYTES)


class _RefusalError(HTTPException):
    """The body of a request is none that its route takes; it is not read."""

    def __init__(self, status: HTTPStatus, detail: str) -> None:
        super().__init__(status, detail, headers={"Connection": "close"})


class _Exchange:
    """The messages of one request, of which no more than `limit` bytes of body are let through."""

    def __init__(self, receive: Receive, send: Send, limit: int, advice: str) -> None:
        self._receive = receive
        self._send = send
        self._limit = limit
        self._advice = advice
        self._received = 0
        self._refused = False
        self._body: bytes | None = None

    def check_length(self, headers: Headers) -> None:
        """Refuse a body that says of itself that it is too long."""
        length = headers.get("content-length", "0")
        if length.isdecimal() and int(length) > self._limit:
            self._refuse_length()

    def check_type(self, headers: Headers, expected: str) -> None:
        """Refuse a body of another media type."""
        found = headers.get("content-type", "").partition(";")[0].strip().lower()
        if found != expected:
            self._refuse(HTTPStatus.UNSUPPORTED_MEDIA_TYPE, f"expected {expected}, found {found[:100]!r}")

    async def read_ahead(self) -> bool:
        """Read the whole body, to be received as one message. Return False if the client went away."""
        parts = []
        more = True
        while more:
            message = await self.receive()
            if message["type"] == "http.disconnect":
                return False
            parts.append(message.get("body", b""))
            more = message.get("more_body", False)
        self._body = b"".join(parts)
        return True

    async def receive(self) -> Message:
        if self._body is not None:
            body, self._body = self._body, None
            return {"type": "http.request", "body": body, "more_body": False}
        message = await self._receive()
        self._received += len(message.get("body", b""))
        if self._received > self._limit:
            self._refuse_length()
        return message

    def _refuse_length(self) -> NoReturn:
        detail = f"expected at most {self._limit} bytes{self._advice}"
        self._refuse(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, detail)

    def _refuse(self, status: HTTPStatus, detail: str) -> NoReturn:
        self._refused = True
        raise _RefusalError(status, detail)

    async def send(self, message: Message) -> None:
        if not self._refused or message["type"] != "http.response.body" or message.get("more_body", False):
            await self._send(message)
            return
        await self._send({**message, "more_body": True})
        await self._discard()
        await self._send({"type": "http.response.body", "body": b""})

    async def _discard(self) -> None:
        discarded = 0
        with anyio.move_on_after(DISCARDING_S):
            while discarded <= DISCARDED_BYTES:
                message = await self._receive()
                discarded += len(message.get("body", b""))
                if not message.get("more_body", False):
                    return
