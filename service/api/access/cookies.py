"""The cookie of a session."""

from http.cookies import CookieError, SimpleCookie

from starlette.datastructures import Headers
from starlette.responses import Response

NAME = "statorwatch_session"
SECURE_NAME = f"__Host-{NAME}"
"""With TLS. A browser takes such a cookie from this host alone, and sends it nowhere else (RFC 6265bis)."""


def session_secret(headers: Headers) -> str | None:
    """Return the secret of the session that a request names; None where it names none."""
    found: SimpleCookie = SimpleCookie()
    try:
        found.load("; ".join(headers.getlist("cookie")))
    except CookieError:
        return None
    for name in (SECURE_NAME, NAME):
        if name in found:
            return found[name].value
    return None


def set_session(response: Response, secret: str, *, seconds: float, encrypted: bool) -> None:
    """Give a browser the secret of a session: no script reads it, and no other site has it sent."""
    response.set_cookie(
        SECURE_NAME if encrypted else NAME,
        secret,
        max_age=round(seconds),
        path="/",
        secure=encrypted,
        httponly=True,
        samesite="strict",
    )


def clear_session(response: Response, *, encrypted: bool) -> None:
    """Have a browser forget its session."""
    name = SECURE_NAME if encrypted else NAME
    response.delete_cookie(name, path="/", secure=encrypted, httponly=True, samesite="strict")
