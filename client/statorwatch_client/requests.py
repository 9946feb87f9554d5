"""A request to the API before it is sent, and what its answer holds: the same for both clients."""

import re
import ssl
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import date
from os import PathLike
from pathlib import PurePosixPath
from typing import Any, TypeAlias
from urllib.parse import quote

import httpx

from statorwatch_client.errors import ServiceError, asked, without_credentials

Time: TypeAlias = str | date
"""An RFC 3339 text, a datetime with its zone, or a date (UTC)."""

Document: TypeAlias = Mapping[str, object]
"""A JSON object of the API, whichever it is."""

Value: TypeAlias = str | float | date | Sequence[str] | None

BROKEN = (httpx.TransportError, httpx.UnsupportedProtocol, httpx.DecodingError)
"""By these errors of httpx nobody answers, or the answer breaks off."""

TIMEOUT_S = 30.0
FILE_TIMEOUT_S = 600.0
"""An Excel file begins to come when its last row is written."""


@dataclass(frozen=True)
class Request:
    """One request. Query values that are None are not sent: the service has its own defaults."""

    method: str
    path: str
    query: Mapping[str, Value] = field(default_factory=dict)
    headers: Mapping[str, str | None] = field(default_factory=dict)
    json: object = None
    content: bytes | None = None
    form: Mapping[str, str] | None = None
    files: Mapping[str, bytes] | None = None

    def made_by(self, http: httpx.Client | httpx.AsyncClient) -> httpx.Request:
        """Return it as httpx sends it."""
        return http.build_request(
            self.method,
            self.path,
            params=[(name, one) for name, value in self.query.items() for one in _texts(value)],
            headers={name.encode(): text.encode() for name, text in self.headers.items() if text is not None},
            json=self.json,
            content=self.content,
            data=self.form,
            files=None if self.files is None else [("files", part) for part in self.files.items()],
        )


def segment(name: str) -> str:
    """Return a name as one segment of a path."""
    return quote(name, safe="")


def _texts(value: Value) -> list[str]:
    if value is None:
        return []
    if isinstance(value, bool):
        return [str(value).lower()]
    if isinstance(value, date):
        return [value.isoformat()]
    if isinstance(value, str | float | int):
        return [str(value)]
    return list(value)


def address(url: str) -> httpx.URL:
    """Return the address of a service. Raises ServiceError, without a password that may stand in it."""
    wrong = f"{without_credentials(url)}: expected a URL such as http://127.0.0.1:8710"
    try:
        parsed = httpx.URL(url)
    except httpx.InvalidURL:  # it quotes what it takes for the port, which may be part of a password
        raise ServiceError(wrong) from None
    if parsed.scheme not in ("http", "https") or not parsed.host or "@" in parsed.host:
        raise ServiceError(wrong)
    return parsed


def trust(url: httpx.URL, ca_file: str | PathLike[str] | None) -> ssl.SSLContext | bool:
    """Return whom TLS trusts: the system's authorities (or SSL_CERT_FILE), and those of a file.

    Raises ServiceError.
    """
    if url.scheme != "https":
        return False
    context = ssl.create_default_context()
    if ca_file is not None:
        try:
            context.load_verify_locations(ca_file)
        except OSError as error:  # ssl.SSLError is one
            raise ServiceError(f"{ca_file}: expected certificates (PEM): {error}") from error
    return context


def bearer(token: str | None) -> dict[str, str]:
    """Return the header that shows a token. Raises ServiceError for what no header can hold."""
    if token is None:
        return {}
    if not token.isascii() or not token.isprintable() or any(mark in token for mark in ' ";,\\'):
        raise ServiceError("expected a token of letters, digits, - and _, found something else")
    return {"Authorization": f"Bearer {token}"}


def document_in(response: httpx.Response) -> dict[str, Any]:
    """Return the JSON object that an answer holds. Raises ServiceError."""
    try:
        document = response.json()
    except ValueError as error:
        found = response.headers.get("content-type")
        raise ServiceError(f"{asked(response)}: expected JSON, found {found}") from error
    if not isinstance(document, dict):
        raise ServiceError(f"{asked(response)}: expected a JSON object")
    return document


def items_in(response: httpx.Response) -> tuple[list[dict[str, Any]], str | None]:
    """Return the items of a page, and the cursor of the next one. Raises ServiceError."""
    page = document_in(response)
    items, following = page.get("items"), page.get("next_cursor")
    if not isinstance(items, list) or not all(isinstance(item, dict) for item in items):
        raise ServiceError(f"{asked(response)}: expected a list of items")
    return items, following if isinstance(following, str) else None


def name_of_file(response: httpx.Response) -> str | None:
    """Return the name that a file is sent with, if it is a plain one without folders."""
    disposition = response.headers.get("Content-Disposition", "")
    named = re.search(r'filename="([A-Za-z0-9_-][A-Za-z0-9._-]*)"', disposition)
    return PurePosixPath(named[1]).name if named else None
