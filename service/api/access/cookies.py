"""The cookie of a session."""

from http.cookies import CookieError, SimpleCookie

from starlette.datastructures import Headers
from starlette.responses import Response

NAME = "statorwatch_session"
SECURE_NAME = f"__Host-{NAME}"
"""With TLS. A browser takes such a cookie from this host alone, and sends it nowhere else (RFC 6265bis)."""


def session_secret(headers: Headers, *, encrypted: bool) -> str | None:
    """Return the secret of the session that a request names; None where it names none.

    With TLS the cookie of the plain name counts for nothing: other hosts and requests in clear can set it.
    """
    found: SimpleCookie = SimpleCookie()
    try:
        found.load("; ".join(headers.getlist("cookie")))
    except CookieError:
        return None
    name = _name(encrypted=encrypted)
    return found[name].value if name in found else None


def set_session(response: Response, secret: str, *, seconds: float, encrypted: bool) -> None:
    """Give a browser the secret of a session: no script reads it, and no other site has it sent."""
    response.set_cookie(
        _name(encrypted=encrypted),
        secret,
        max_age=round(seconds),
        path="/",
        secure=encrypted,
        httponly=True,
        samesite="strict",
    )


def clear_session(response: Response, *, encrypted: bool) -> None:
    """Have a browser forget its session."""
    response.delete_cookie(
        _name(encrypted=encrypted), path="/", secure=encrypted, httponly=True, samesite="strict"
    )


def _name(*, encrypted: bool) -> str:
    return SECURE_NAME if encrypted else NAME
