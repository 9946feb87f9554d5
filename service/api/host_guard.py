"""Keeps out what comes by way of somebody's web browser.

A browser sends the cookie of a session with what any web page there asks of us, and while there are no users
this computer is trusted. A browser tells on such a page: one of another site sends its Origin, and that it is
of another site (Sec-Fetch-Site); a site that pretends to be at our address (DNS rebinding) sends its own name
as Host.
"""

from collections.abc import Collection
from http import HTTPStatus
from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Receive, Scope, Send

from service.api.problems import problem_response

READING = ("GET", "HEAD")
OF_OUR_PAGES = ("same-origin", "none")
"""A browser says so of a request of our own page, and of one that a person made by hand."""


class HostGuard:
    """ASGI middleware. `hosts`: names this service goes by; "*" for any."""

    def __init__(self, app: ASGIApp, *, hosts: Collection[str]) -> None:
        self._app = app
        self._hosts = {host.lower() for host in hosts}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        refusal = self._refusal(scope["method"], Headers(scope=scope))
        if refusal is None:
            await self._app(scope, receive, send)
            return
        status, detail = refusal
        await problem_response(scope["path"], status, detail)(scope, receive, send)

    def _refusal(self, method: str, headers: Headers) -> tuple[HTTPStatus, str] | None:
        host = headers.get("host", "")
        if not self._is_ours(host):
            return (
                HTTPStatus.MISDIRECTED_REQUEST,
                f"this service does not go by the name {host[:100]!r}; "
                "see allowed_hosts in docs/reference/settings.md",
            )
        origin = headers.get("origin")
        if origin is not None and _network_location(origin) != host.lower():
            return HTTPStatus.FORBIDDEN, f"requests from web pages of {origin[:100]!r} are refused"
        if method not in READING and headers.get("sec-fetch-site", "none") not in OF_OUR_PAGES:
            return HTTPStatus.FORBIDDEN, "requests from web pages of other sites are refused"
        return None

    def _is_ours(self, host: str) -> bool:
        if "*" in self._hosts:
            return True
        try:
            return (urlsplit(f"//{host}").hostname or "") in self._hosts
        except ValueError:
            return False


def _network_location(origin: str) -> str:
    try:
        return urlsplit(origin).netloc.lower()
    except ValueError:
        return ""
