"""Addresses of our own pages."""

from collections.abc import Mapping
from typing import Final
from urllib.parse import quote, urlencode, urlsplit

LONGEST: Final = 2000


def path_segment(name: str) -> str:
    """Return a name as a segment of a path; dots alone would lead elsewhere."""
    return quote(name, safe="") if name.strip(".") else name.replace(".", "%2E")


def address(path: str, /, *segments: str, **query: object) -> str:
    """Return a path with names as further segments and a query; what is None or empty is left out of it."""
    whole = "/".join([path.rstrip("/"), *map(path_segment, segments)]) if segments else path
    return with_query(whole, query)


def with_query(path: str, query: Mapping[str, object]) -> str:
    """Return a path, which may have a query, with more of one; what is None or empty is left out of it."""
    given = {name: value for name, value in query.items() if value is not None and value != ""}
    path, hash_sign, place = path.partition("#")
    joint = "&" if "?" in path else "?"
    return f"{path}{joint if given else ''}{urlencode(given, doseq=True)}{hash_sign}{place}"


def own_address(text: str | None, default: str = "/") -> str:
    """Return an address of this site, as somebody gave it, or `default` where it may lead to another one."""
    if not text or len(text) > LONGEST or not text.startswith("/") or text.startswith(("//", "/\\")):
        return default
    if "\\" in text or any(ord(sign) < 0x21 or ord(sign) == 0x7F for sign in text):
        return default
    try:
        parts = urlsplit(text)
    except ValueError:
        return default
    return default if parts.scheme or parts.netloc else text
