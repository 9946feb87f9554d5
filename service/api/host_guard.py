"""Keeps out what comes by way of somebody's web browser.

The API has no passwords: it trusts those who can reach its address, by default programs on this computer. A
web page in a browser there could reach it too. A browser tells on it: a page of another site sends its
Origin, and a site that pretends to be at our address (DNS rebinding) sends its own name as Host.
"""

from collections.abc import Collection
from http import HTTPStatus
from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Receive, Scope, Send

from service.api.problems import problem_response


class HostGuard:
    """ASGI middleware. `hosts`: names this service goes by; "*" for any."""

    def __init__(self, app: ASGIApp, *, hosts: Collection[str]) -> None:
        self._app = app
        self._hosts = {host.lower() for host in hosts}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        refusal = self._refusal(Headers(scope=scope))
        if refusal is None:
            await self._app(scope, receive, send)
            return
        status, detail = refusal
        await problem_response(scope["path"], status, detail)(scope, receive, send)

    def _refusal(self, headers: Headers) -> tuple[HTTPStatus, str] | None:
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
