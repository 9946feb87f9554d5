"""The client of one service."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from http import HTTPStatus
from os import PathLike
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO, Self

import httpx

from statorwatch_client.errors import ServiceError, refusal, without_credentials
from statorwatch_client.operations import Operations
from statorwatch_client.requests import (
    BROKEN,
    FILE_TIMEOUT_S,
    TIMEOUT_S,
    Request,
    address,
    bearer,
    document_in,
    items_in,
    name_of_file,
    trust,
)


class Download:
    """A file that the service sends, while it comes. `name` is None where the service gives it none."""

    def __init__(self, response: httpx.Response, address: str) -> None:
        self.name = name_of_file(response)
        self.media_type = response.headers.get("Content-Type", "").partition(";")[0]
        self._response = response
        self._address = address

    def iter_bytes(self) -> Iterator[bytes]:
        """Yield the file, piece after piece. Raises ServiceError where the service breaks it off."""
        size_bytes = 0
        try:
            for piece in self._response.iter_bytes():
                size_bytes += len(piece)
                yield piece
        except BROKEN as error:
            raise ServiceError(
                f"{self._address}: broken off after {size_bytes} bytes ({error}); the log of the "
                "service says why"
            ) from error

    def iter_lines(self) -> Iterator[str]:
        """Yield the lines of a text. Raises ServiceError where the service breaks it off."""
        try:
            yield from self._response.iter_lines()
        except BROKEN as error:
            raise ServiceError(f"{self._address}: did not send all of its answer ({error})") from error

    def read(self) -> bytes:
        """Return the whole file. Raises ServiceError where the service breaks it off."""
        return b"".join(self.iter_bytes())

    def save(self, target: str | PathLike[str] | BinaryIO) -> int:
        """Write the file to a path or into an open file, and return its size in bytes.

        Raises ServiceError where the service breaks it off, and OSError of the disk.
        """
        if isinstance(target, str | PathLike):
            with Path(target).open("wb") as sink:
                return self.save(sink)
        return sum(target.write(piece) for piece in self.iter_bytes())


class Client(Operations):
    """The client of one service. It has a function for each route; every failure is a ServiceError.

    Parameters
    ----------
    url
        Where the service is, such as http://127.0.0.1:8710.
    token
        An API token; without it the service is asked as nobody.
    ca_file
        Certificates (PEM) of authorities that TLS trusts besides the system's.
    headers
        Sent with each request.
    timeout_s
        The longest wait for a part of an answer [s].
    """

    _advice = ""

    def __init__(
        self,
        url: str,
        *,
        token: str | None = None,
        ca_file: str | PathLike[str] | None = None,
        headers: Mapping[str, str] | None = None,
        timeout_s: float = TIMEOUT_S,
    ) -> None:
        parsed = address(url)
        self.url = without_credentials(url)
        self._http = httpx.Client(
            base_url=parsed,
            timeout=timeout_s,
            trust_env=False,  # a proxy of the environment is for the internet, not for the plant
            headers={**(headers or {}), **bearer(token)},
            verify=trust(parsed, ca_file),
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

    def _answer(self, request: Request) -> httpx.Response:
        try:
            response = self._http.send(request.made_by(self._http))
        except BROKEN as error:
            raise self._silence(error) from error
        if not response.is_success:
            raise refusal(response)
        return response

    def _silence(self, error: Exception) -> ServiceError:
        return ServiceError(f"no service answers at {self.url} ({error}){self._advice}")

    def _document(self, request: Request) -> Any:
        return document_in(self._answer(request))

    def _new_document(self, request: Request) -> tuple[Any, bool]:
        response = self._answer(request)
        return document_in(response), response.status_code == HTTPStatus.CREATED

    def _done(self, request: Request) -> None:
        self._answer(request)

    def _items(self, request: Request) -> Iterator[Any]:
        while True:
            items, cursor = items_in(self._answer(request))
            yield from items
            if cursor is None:
                return
            request = replace(request, query={**request.query, "cursor": cursor})

    @contextmanager
    def _file(self, request: Request) -> Iterator[Download]:
        asked = request.made_by(self._http)
        asked.extensions["timeout"] = httpx.Timeout(FILE_TIMEOUT_S).as_dict()
        try:
            response = self._http.send(asked, stream=True)
        except BROKEN as error:
            raise self._silence(error) from error
        try:
            if not response.is_success:
                response.read()
                raise refusal(response)
            yield Download(response, f"{self.url.rstrip('/')}{request.path}")
        finally:
            response.close()
