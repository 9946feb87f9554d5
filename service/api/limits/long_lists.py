"""Long lists: few are made at a time, and each is sent in pieces, so that they do not fill the memory."""

import asyncio
from contextlib import AsyncExitStack
from urllib.parse import parse_qs

import structlog
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from structlog.typing import FilteringBoundLogger

from service.api.limits.admission import Admission
from service.api.pages import DEFAULT_LIMIT
from service.api.problems import BusyError, busy_response

log: FilteringBoundLogger = structlog.get_logger(__name__)

MADE_AT_ONCE = 2
SENT_AT_ONCE = 16
WAIT_S = 10.0

SENDING_LIMIT_S = 20.0
"""A client that has not taken its list by then loses it: the list is held in memory meanwhile."""

LONG_ITEMS = "/diagnoses"
"""The items of lists at such paths have some kilobytes."""

PIECE_BYTES = 1 << 16
"""The next piece is handed over when the client has taken most of those before it."""


class LongLists:
    """ASGI middleware for requests whose page may be longer than by default."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app
        self._made = Admission("long lists", MADE_AT_ONCE, wait_s=WAIT_S)
        self._sent = Admission("long lists", SENT_AT_ONCE, wait_s=WAIT_S)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http" or not _is_long(scope):
            await self._app(scope, receive, send)
            return
        try:
            async with self._sent.admitted(), AsyncExitStack() as making:
                await making.enter_async_context(self._made.admitted())
                await self._answer(scope, receive, send, making)
        except BusyError as error:
            await busy_response(scope["path"], str(error))(scope, receive, send)

    async def _answer(self, scope: Scope, receive: Receive, send: Send, making: AsyncExitStack) -> None:
        async def send_in_pieces(message: Message) -> None:
            if message["type"] == "http.response.start":
                await making.aclose()
                sending.reschedule(asyncio.get_running_loop().time() + SENDING_LIMIT_S)
            body = message.get("body", b"")
            while len(body) > PIECE_BYTES:
                await send({**message, "body": body[:PIECE_BYTES], "more_body": True})
                body = body[PIECE_BYTES:]
            await send({**message, "body": body} if "body" in message else message)

        try:
            async with asyncio.timeout(None) as sending:
                await self._app(scope, receive, send_in_pieces)
        except TimeoutError:
            if not sending.expired():
                raise
            log.warning("a client was too slow to take its list", limit_s=SENDING_LIMIT_S)


def _is_long(scope: Scope) -> bool:
    """Tell whether a page may be longer than by default, however its limit is written, or has long items."""
    if scope["method"] == "GET" and scope["path"].endswith(LONG_ITEMS):
        return True
    limits = parse_qs(scope["query_string"].decode("latin-1"), keep_blank_values=True).get("limit", [])
    return any(not (limit.isdecimal() and len(limit) < 9 and int(limit) <= DEFAULT_LIMIT) for limit in limits)
