"""What browsers are told not to do with our pages."""

from typing import Final

from starlette.datastructures import MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.api.access.client_address import client_address
from service.configuration.access import ProxySettings

POLICY: Final = "; ".join(
    (
        "default-src 'none'",
        "script-src 'self'",
        "style-src 'self'",
        "img-src 'self' data:",
        "connect-src 'self'",
        "form-action 'self'",
        "base-uri 'none'",
        "frame-ancestors 'none'",
    )
)
"""No script and no style but those of our own files runs, whatever text a relay or a person has put in."""

HEADERS: Final = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
}


ENCRYPTED_ALWAYS: Final = {"Strict-Transport-Security": "max-age=31536000"}
"""Where TLS is on: browsers ask in clear no more for a year, so that nobody on the way leads them astray."""


class SecurityHeaders:
    """ASGI middleware that adds them to every answer; an answer's own policy, which is stricter, stays.

    proxy: that of the settings, which tells whether its clients use TLS.
    """

    def __init__(self, app: ASGIApp, *, proxy: ProxySettings | None) -> None:
        self._app = app
        self._proxy = proxy

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return

        added = HEADERS | (ENCRYPTED_ALWAYS if client_address(scope, self._proxy).is_encrypted else {})

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                headers.setdefault("Content-Security-Policy", POLICY)
                for name, value in added.items():
                    headers.setdefault(name, value)
            await send(message)

        await self._app(scope, receive, send_with_headers)
