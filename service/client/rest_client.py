"""The client of the service for the command line and the demo: it knows who asks, and whom TLS trusts."""

import os
from collections.abc import Iterator
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from service.client.credentials import COOKIES, CredentialsError, bearer, headers_for
from statorwatch_client import Client, ProblemError, ServiceError
from statorwatch_client.errors import without_credentials
from statorwatch_client.requests import Document, Request, Value, address, segment

if TYPE_CHECKING:
    from statorwatch_client.models import Account, EventReport, RecordingWanted

__all__ = [
    "API",
    "Document",
    "ServiceClient",
    "ServiceError",
    "is_in_clear",
    "segment",
    "without_credentials",
]

API = "/api/v1"
CA_VARIABLE = "MCC_CA"


class ServiceClient(Client):
    """A client of one service. It returns documents as JSON objects; every failure is a ServiceError.

    anonymous: does not say who asks. token: says it; by default what the environment or `mcc login` has for
    the service. MCC_CA names a file with certificates of authorities that TLS trusts, besides the system's.
    """

    _advice = "; start it with mcc serve"

    def __init__(self, url: str, *, token: str | None = None, anonymous: bool = False) -> None:
        address(url)
        try:
            headers = {} if anonymous else headers_for(url) if token is None else bearer(token)
        except CredentialsError as error:
            raise ServiceError(str(error)) from error
        super().__init__(url, headers=headers, ca_file=os.environ.get(CA_VARIABLE) or None)

    def is_ready(self) -> bool:
        """Tell whether every part of the service works."""
        try:
            self.get_readiness()
        except ServiceError:
            return False
        return True

    def what_is_not_ready(self) -> str | None:
        """Return which parts of the service do not work, and why; None where all do or nothing answers."""
        try:
            self.get_readiness()
        except ProblemError as error:
            return error.problem["detail"]
        except ServiceError:
            return None
        return None

    def answers(self) -> bool:
        """Tell whether anything answers at the address, ready or not."""
        try:
            self.get_health_of_service()
        except ServiceError as error:
            return error.status is not None
        return True

    def begin_session(self, name: str, password: str, code: str | None = None) -> "tuple[Account, str]":
        """Begin a session, and return the account and the session's secret. Raises ServiceError.

        code: of the second factor.
        """
        account = self.log_in({"name": name, "password": password, "code": code})
        secret = self._http.cookies.get(COOKIES[self._http.base_url.scheme])
        if secret is None:
            raise ServiceError(f"{self.url}: expected the cookie of a session, found none")
        return account, secret

    def request_recording(
        self, motor: str, *, idempotency_key: str | None = None, seconds: float | None = None
    ) -> "EventReport":
        """Request a recording of the motor; the same key again requests nothing new.

        seconds: so much, as a series of recordings that is joined; None for one. Raises ServiceError.
        """
        wanted: RecordingWanted | None = None if seconds is None else {"seconds": seconds}
        return self.request_event_report(motor, wanted, idempotency_key=idempotency_key)

    def get(self, path: str, **query: Value) -> Document:
        """Get a document below /api/v1 whose path is known at run time only. Raises ServiceError."""
        found: Document = self._document(Request("GET", f"{API}{path}", query))
        return found

    def items(self, path: str, **query: Value) -> Iterator[Document]:
        """Yield the items of a list below /api/v1, page after page. Raises ServiceError."""
        return self._items(Request("GET", f"{API}{path}", query))


def is_in_clear(url: str) -> bool:
    """Tell whether others on the network can read what is sent there."""
    parsed = urlsplit(url)
    return parsed.scheme == "http" and (parsed.hostname or "") not in ("localhost", "127.0.0.1", "::1")
