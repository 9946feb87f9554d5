"""Errors for people who look at pages: problem documents become pages, or parts of them.

The API's own paths keep their documents. Who has to log in first is sent to do so, and back afterwards.
"""

import json
import re
from http import HTTPStatus
from typing import Final
from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.responses import RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.api.problems import MEDIA_TYPE
from service.web.addresses import address, own_address
from service.web.rendering import html_response, rendered

API: Final = "/api/"
LOGIN: Final = "/login"
LONGEST_BODY: Final = 1_000_000
KEPT: Final = frozenset(("allow", "retry-after"))
"""What an answer in place of a problem document says too."""

_PLACE: Final = re.compile(r"\b(?:body|query|path)\.(?:[a-z_0-9]+\.)*?([a-z_]+)(?:\.\d+)?:")
FIELDS: Final = {
    "text": "what happened",
    "time": "when",
    "until": "shelved until",
    "growth": "grown by",
    "from_s": "from",
    "to_s": "to",
}
"""How pages call a field of the API where its name alone says little."""

WHAT_TO_DO: Final = {
    HTTPStatus.UNAUTHORIZED: "Log in, then come back: what you typed is kept in this tab.",
    HTTPStatus.FORBIDDEN: "Ask somebody who may, or an administrator for the role.",
    HTTPStatus.NOT_FOUND: "It may have another name by now, or be gone. Begin at the first page.",
    HTTPStatus.GONE: "Take the newest link that the terminal shows (mcc demo), or log in with a name and"
    " password.",
    HTTPStatus.CONFLICT: "Load the page again to see how things are now.",
    HTTPStatus.UNPROCESSABLE_ENTITY: "Go back, correct it and send it again.",
    HTTPStatus.TOO_MANY_REQUESTS: "Wait a minute, then try again.",
    HTTPStatus.NOT_IMPLEMENTED: "All else works without it. Tell who runs the service.",
    HTTPStatus.SERVICE_UNAVAILABLE: "Nothing was changed. Try again in a few seconds.",
    HTTPStatus.INTERNAL_SERVER_ERROR: "The service's log says more. Try again, or tell who runs the service.",
}


class HtmlProblems:
    """ASGI middleware around the whole application."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http" or scope["path"].startswith(API):
            await self._app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        if "text/html" not in headers.get("accept", "") and "hx-request" not in headers:
            await self._app(scope, receive, send)
            return
        start: Message | None = None
        body = b""

        async def send_page(message: Message) -> None:
            nonlocal start, body
            if message["type"] == "http.response.start" and _is_problem(message):
                start = message
            elif start is None:
                await send(message)
            elif message["type"] == "http.response.body":
                body = (body + message.get("body", b""))[:LONGEST_BODY]
                if not message.get("more_body", False):
                    await _answer(scope, headers, start, body)(scope, receive, send)

        await self._app(scope, receive, send_page)


def _is_problem(message: Message) -> bool:
    return Headers(raw=message["headers"]).get("content-type", "").startswith(MEDIA_TYPE)


def _answer(scope: Scope, headers: Headers, start: Message, body: bytes) -> Response:
    problem = json.loads(body)
    status: int = start["status"]
    htmx = headers.get("hx-request") == "true"
    is_reading = scope["method"] in ("GET", "HEAD")
    here = own_address(_whole_path(scope))
    if status == HTTPStatus.UNAUTHORIZED and is_reading and not htmx and scope["path"] != LOGIN:
        return RedirectResponse(address(LOGIN, next=here), status_code=HTTPStatus.SEE_OTHER)
    if status == HTTPStatus.FORBIDDEN and is_reading and scope["path"] == "/":
        return RedirectResponse("/account", status_code=HTTPStatus.SEE_OTHER)
    detail = problem["detail"]
    if status == HTTPStatus.NOT_FOUND and detail.startswith("nothing is at "):
        detail = f"there is no page at {scope['path'][:200]}"
    about = {
        "title": problem["title"],
        "detail": in_words(detail),
        "advice": WHAT_TO_DO.get(HTTPStatus(status), "Go back and try again."),
        "login": address(LOGIN, next=_page_of(headers)) if status == HTTPStatus.UNAUTHORIZED else None,
    }
    template = "errors/fragment.html" if htmx else "errors/page.html"
    answer = html_response(rendered(template, **about), headers, status=status, cache="no-store")
    if htmx:
        answer.headers["HX-Retarget"] = "#messages"
        answer.headers["HX-Reswap"] = "innerHTML"
        answer.headers["HX-Reselect"] = ".message"  # whatever part of a page was asked for
        answer.headers["HX-Push-Url"] = "false"  # the page stays where it is
    said = Headers(raw=start["headers"])
    for name in KEPT & set(said):
        answer.headers[name] = said[name]
    return answer


def in_words(detail: str) -> str:
    """Return what a problem says with the field's words for its place in a document: no body.mu_f."""
    return _PLACE.sub(lambda found: f"{FIELDS.get(found[1], found[1].replace('_', ' '))}:", detail)


def _page_of(headers: Headers) -> str:
    """Return the page that a form was sent from, so that a login leads back to it and to what was typed."""
    parts = urlsplit(headers.get("hx-current-url") or headers.get("referer") or "/")
    return own_address(parts.path + (f"?{parts.query}" if parts.query else ""))


def _whole_path(scope: Scope) -> str:
    raw: bytes = scope.get("raw_path") or scope["path"].encode()
    query: bytes = scope["query_string"]
    return (raw + (b"?" + query if query else b"")).decode("latin-1")
