"""Answers to requests whose bodies are not read, sent so that their clients get to see them."""

import anyio
from starlette.responses import Response
from starlette.types import Message, Receive, Scope, Send

from service.api.limits.body_limits import DISCARDED_BYTES, DISCARDING_S


async def refuse(response: Response, scope: Scope, receive: Receive, send: Send) -> None:
    """Send an answer at once, then throw some of the body away that the client may still be sending."""
    headers = dict(scope["headers"])
    if b"transfer-encoding" not in headers and headers.get(b"content-length", b"0") == b"0":
        await response(scope, receive, send)
        return
    response.headers["Connection"] = "close"

    async def send_and_discard(message: Message) -> None:
        if message["type"] != "http.response.body" or message.get("more_body", False):
            await send(message)
            return
        await send({**message, "more_body": True})
        await _discard(receive)
        await send({"type": "http.response.body", "body": b""})

    await response(scope, receive, send_and_discard)


async def _discard(receive: Receive) -> None:
    discarded = 0
    with anyio.move_on_after(DISCARDING_S):
        while discarded <= DISCARDED_BYTES:
            message = await receive()
            discarded += len(message.get("body", b""))
            if not message.get("more_body", False):
                return
