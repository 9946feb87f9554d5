"""Requests to one service over HTTP: who asks, what an answer must be, and what is said where it is not."""

import re
import ssl
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime
from http import HTTPStatus
from types import TracebackType
from typing import Any, BinaryIO, Self
from urllib.parse import quote, urlsplit

import httpx

from statorwatch_client.errors import ServiceError

TIMEOUT_S = 30.0
FILE_TIMEOUT_S = 600.0
"""An Excel file begins to come when its last row is written."""

PART_OF_REQUEST = re.compile(r"(^|; )(?:body|path|query)\.(?=\w+: )")
"""Where in an HTTP request a wrong value was says nothing to people."""

Query = Mapping[str, object]


class Transport:
    """Sends requests to one service. Every failure is a ServiceError. A context manager that closes it.

    Parameters
    ----------
    url : str
        Address of the service, "http://127.0.0.1:8710".
    headers : mapping of str to str
        Headers that say who asks.
    verify : ssl.SSLContext or None
        Whom TLS trusts; None for the authorities of the system.
    timeout_s : float
        An answer that takes longer is given up [s].

    Raises
    ------
    ServiceError
        The address is none.
    """

    def __init__(
        self,
        url: str,
        *,
        headers: Mapping[str, str] | None = None,
        verify: ssl.SSLContext | None = None,
        timeout_s: float = TIMEOUT_S,
    ) -> None:
        self.url = without_credentials(url)
        wrong = f"{self.url}: expected a URL such as http://127.0.0.1:8710"
        try:
            parsed = httpx.URL(url)
        except httpx.InvalidURL:  # it quotes what it takes for the port, which may be part of a password
            raise ServiceError(wrong) from None
        if parsed.scheme not in ("http", "https") or not parsed.host or "@" in parsed.host:
            raise ServiceError(wrong)
        self.scheme = parsed.scheme
        trusted = (verify or ssl.create_default_context()) if parsed.scheme == "https" else False
        self._http = httpx.Client(
            base_url=parsed, timeout=timeout_s, trust_env=False, headers=headers, verify=trusted
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the connections."""
        self._http.close()

    def document(
        self,
        method: str,
        path: str,
        *,
        query: Query | None = None,
        headers: Query | None = None,
        json: object = None,
        form: Mapping[str, str] | None = None,
        files: Mapping[str, bytes] | None = None,
        text: bytes | None = None,
    ) -> Any:
        """Send a request; return its answer's JSON object, or None where the answer has no body.

        Raises
        ------
        ServiceError
            Nothing answers, the service refuses, or its answer is no JSON object.
        """
        response = self.answer(
            method, path, query=query, headers=headers, json=json, form=form, files=files, text=text
        )
        return _document(response) if response.content else None

    def answer(
        self,
        method: str,
        path: str,
        *,
        query: Query | None = None,
        headers: Query | None = None,
        json: object = None,
        form: Mapping[str, str] | None = None,
        files: Mapping[str, bytes] | None = None,
        text: bytes | None = None,
    ) -> httpx.Response:
        """Send a request; return its answer as it is.

        Parameters
        ----------
        method, path : str
            The request.
        query, headers : mapping of str to object
            What goes into the address and the head; what is None is left out.
        json : object
            A document that is sent; None for none.
        form : mapping of str to str
            Fields of a form.
        files : mapping of str to bytes
            Contents of files by name, beside the form.
        text : bytes
            A text that is sent.

        Raises
        ------
        ServiceError
            Nothing answers, or the service refuses.
        """
        heads = {name.encode(): told.encode() for name, told in _told(headers)}
        if text is not None:
            heads[b"Content-Type"] = b"text/plain"
        try:
            response = self._http.request(
                method,
                path,
                params=_told(query),
                headers=heads,
                content=text,
                json=json,
                data=form,
                files=None if files is None else [("files", part) for part in files.items()],
            )
        except (httpx.TransportError, httpx.UnsupportedProtocol) as error:
            raise ServiceError(self._nobody(error)) from error
        if response.is_success:
            return response
        raise ServiceError(_problem(response), status=response.status_code)

    def listed(self, page: Mapping[str, Any], path: str) -> list[Any]:
        """Return the items of a page. Raises ServiceError where it is none: another service answers."""
        items = page.get("items")
        if not isinstance(items, list) or not all(isinstance(item, dict) for item in items):
            raise ServiceError(f"{self.url}{path}: expected a list of items")
        return items

    def save(self, path: str, sink: BinaryIO, *, query: Query | None = None) -> int:
        """Write a file that the service makes into `sink`, as it comes; return its size [bytes].

        Raises
        ------
        ServiceError
            Nothing answers, the service refuses, or the file was broken off.
        OSError
            The sink takes it not.
        """
        size_bytes = 0
        try:
            with self._stream(path, query) as response:
                for piece in response.iter_bytes():
                    sink.write(piece)
                    size_bytes += len(piece)
        except (httpx.TransportError, httpx.UnsupportedProtocol) as error:
            if size_bytes:
                raise ServiceError(
                    f"{self.url}{path}: broken off after {size_bytes} bytes ({error}); the log of the "
                    "service says why"
                ) from error
            raise ServiceError(self._nobody(error)) from error
        return size_bytes

    def lines(self, path: str, *, query: Query | None = None) -> Iterator[str]:
        """Yield the lines of a text, while it comes.

        Raises
        ------
        ServiceError
            Nothing answers, the service refuses, or the text was broken off.
        """
        try:
            with self._stream(path, query) as response:
                yield from response.iter_lines()
        except (httpx.TransportError, httpx.UnsupportedProtocol) as error:
            raise ServiceError(f"{self.url} did not send all of its answer ({error})") from error

    @contextmanager
    def _stream(self, path: str, query: Query | None) -> Iterator[httpx.Response]:
        with self._http.stream("GET", path, params=_told(query), timeout=FILE_TIMEOUT_S) as response:
            if not response.is_success:
                response.read()
                raise ServiceError(_problem(response), status=response.status_code)
            yield response

    def status(self, path: str) -> int | None:
        """Return the HTTP status of a page; None where nothing answers."""
        try:
            return self._http.get(path).status_code
        except httpx.TransportError:
            return None

    def unready(self) -> str | None:
        """Return which parts of the service do not work, and why; None where all do or nothing answers."""
        try:
            response = self._http.get("/readyz")
            if response.status_code != HTTPStatus.SERVICE_UNAVAILABLE:
                return None
            document = response.json()
        except (httpx.HTTPError, ValueError):
            return None
        told = document.get("detail") if isinstance(document, dict) else None
        return told if isinstance(told, str) else None

    def _nobody(self, error: Exception) -> str:
        """Return in words that nothing answers."""
        return f"no service answers at {self.url} ({error}); start it with mcc serve"


def without_credentials(url: str) -> str:
    """Return a URL as it may be printed: without what is before its last @, where a password may stand."""
    return re.sub(r"(//|^).*@", r"\1", url, count=1, flags=re.DOTALL)


def is_in_clear(url: str) -> bool:
    """Tell whether others on the network can read what is sent there."""
    parsed = urlsplit(url)
    return parsed.scheme == "http" and (parsed.hostname or "") not in ("localhost", "127.0.0.1", "::1")


def segment(name: str) -> str:
    """Return a name as one segment of a path."""
    return quote(name, safe="")


def _told(fields: Query | None) -> tuple[tuple[str, str], ...]:
    """Return names and values as they are sent; a sequence is sent value by value, None not at all."""
    sent: list[tuple[str, str]] = []
    for name, value in (fields or {}).items():
        several = isinstance(value, Sequence) and not isinstance(value, str)
        for each in value if several else (value,):  # type: ignore[attr-defined]  # several is a sequence
            if each is not None:
                sent.append((name, _word(each)))
    return tuple(sent)


def _word(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, datetime):
        return value.astimezone(UTC).isoformat().replace("+00:00", "Z")
    return str(value)


def _asked(response: httpx.Response) -> str:
    return without_credentials(str(response.url))


def _document(response: httpx.Response) -> dict[str, Any]:
    try:
        document = response.json()
    except ValueError as error:
        found = response.headers.get("content-type")
        raise ServiceError(f"{_asked(response)}: expected JSON, found {found}") from error
    if not isinstance(document, dict):
        raise ServiceError(f"{_asked(response)}: expected a JSON object")
    return document


def _problem(response: httpx.Response) -> str:
    """Return what an RFC 9457 problem document says."""
    try:
        problem = response.json()
    except ValueError:
        problem = None
    if isinstance(problem, dict):
        detail = str(problem.get("detail") or problem.get("title") or f"HTTP status {response.status_code}")
        return PART_OF_REQUEST.sub(r"\1", detail)
    return f"{_asked(response)}: HTTP status {response.status_code}"
