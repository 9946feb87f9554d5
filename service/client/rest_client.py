"""A client of the service's REST API, for the command line and the demo."""

import os
import re
import ssl
from collections.abc import Iterator, Mapping, Sequence
from http import HTTPStatus
from types import TracebackType
from typing import BinaryIO, Self
from urllib.parse import quote, urlsplit

import httpx

from service.client.credentials import COOKIES, CredentialsError, bearer, headers_for

API = "/api/v1"
CA_VARIABLE = "MCC_CA"
TIMEOUT_S = 30.0
FILE_TIMEOUT_S = 600.0
"""An Excel file begins to come when its last row is written."""

DISPOSITION = "Content-Disposition"

PART_OF_REQUEST = re.compile(r"(^|; )(?:body|path|query)\.(?=\w+: )")
"""Where in an HTTP request a wrong value was says nothing to people."""

Document = Mapping[str, object]


class ServiceError(RuntimeError):
    """The service did not do what it was asked. `status` is the HTTP status, None where it did not answer."""

    def __init__(self, message: str, *, status: int | None = None) -> None:
        super().__init__(message)
        self.status = status


class ServiceClient:
    """A client of one service. It returns documents as JSON objects; every failure is a ServiceError.

    anonymous: does not say who asks. token: says it; by default what the environment or `mcc login` has for
    the service. MCC_CA names a file with certificates of authorities that TLS trusts, besides the system's.
    """

    def __init__(self, url: str, *, token: str | None = None, anonymous: bool = False) -> None:
        self._url = without_credentials(url)
        wrong = f"{self._url}: expected a URL such as http://127.0.0.1:8710"
        try:
            parsed = httpx.URL(url)
        except httpx.InvalidURL:  # it quotes what it takes for the port, which may be part of a password
            raise ServiceError(wrong) from None
        if parsed.scheme not in ("http", "https") or not parsed.host or "@" in parsed.host:
            raise ServiceError(wrong)
        try:
            headers = {} if anonymous else headers_for(url) if token is None else bearer(token)
        except CredentialsError as error:
            raise ServiceError(str(error)) from error
        verify = trust() if parsed.scheme == "https" else False
        self._http = httpx.Client(
            base_url=parsed, timeout=TIMEOUT_S, trust_env=False, headers=headers, verify=verify
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._http.close()

    def is_ready(self) -> bool:
        """Tell whether every part of the service works."""
        try:
            return self._http.get("/readyz").status_code == HTTPStatus.OK
        except httpx.TransportError:
            return False

    def what_is_not_ready(self) -> str | None:
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

    def answers(self) -> bool:
        """Tell whether anything answers at the address, ready or not."""
        try:
            self._http.get("/healthz")
        except httpx.TransportError:
            return False
        return True

    def get(self, path: str, **query: str) -> Document:
        """Get a document below /api/v1. Raises ServiceError."""
        return _document(self._request("GET", f"{API}{path}", query))

    def send(self, method: str, path: str, document: Document | None = None) -> Document:
        """Send a document, or none, to a path below /api/v1; return the answer, empty where it has no body.

        Raises ServiceError.
        """
        response = self._request(method, f"{API}{path}", {}, document=document)
        return _document(response) if response.content else {}

    def log_in(self, name: str, password: str) -> tuple[Document, str]:
        """Begin a session, and return the account and the session's secret. Raises ServiceError."""
        wanted = {"name": name, "password": password}
        response = self._request("POST", f"{API}/login", {}, document=wanted)
        secret = response.cookies.get(COOKIES[self._http.base_url.scheme])
        if secret is None:
            raise ServiceError(f"{self._url}: expected the cookie of a session, found none")
        return _document(response), secret

    def items(self, path: str, **query: str) -> Iterator[Document]:
        """Yield every item of a list, page after page. Raises ServiceError."""
        cursor: dict[str, str] = {}
        while True:
            page = self.get(path, **query, **cursor)
            items = page.get("items")
            if not isinstance(items, list) or not all(isinstance(item, dict) for item in items):
                raise ServiceError(f"{self._url}{API}{path}: expected a list of items")
            yield from items
            following = page.get("next_cursor")
            if not isinstance(following, str):
                return
            cursor = {"cursor": following}

    def lines(self, path: str, **query: str) -> Iterator[str]:
        """Yield the lines of a text, while it comes. Raises ServiceError."""
        try:
            with self._http.stream("GET", f"{API}{path}", params=query) as response:
                if not response.is_success:
                    response.read()
                    raise ServiceError(_problem(response), status=response.status_code)
                yield from response.iter_lines()
        except (httpx.TransportError, httpx.UnsupportedProtocol) as error:
            raise ServiceError(f"{self._url} did not send all of its answer ({error})") from error

    def request_recording(
        self, motor: str, *, idempotency_key: str | None = None, seconds: float | None = None
    ) -> Document:
        """Request a recording of the motor; the same key again requests nothing new.

        seconds: so much, as a series of recordings that is joined; None for one. Raises ServiceError.
        """
        headers = {} if idempotency_key is None else {b"Idempotency-Key": idempotency_key.encode()}
        path = f"{API}/motors/{segment(motor)}/event-reports"
        wanted = None if seconds is None else {"seconds": seconds}
        return _document(self._request("POST", path, {}, headers, document=wanted))

    def release(self, relay: str) -> None:
        """End the quarantine of a relay. Raises ServiceError."""
        self._request("DELETE", f"{API}/ieds/{segment(relay)}/quarantine", {})

    def delete_recording(self, recording_id: str, reason: str) -> Document:
        """Delete a recording, and return what the service remembers of it. Raises ServiceError."""
        self._request("DELETE", f"{API}/recordings/{segment(recording_id)}", {"reason": reason})
        return self.get(f"/deletions/{segment(recording_id)}")

    def add_note(self, motor: str, note: Document) -> Document:
        """Tell something of a motor, and return the note that is kept. Raises ServiceError."""
        path = f"{API}/motors/{segment(motor)}/notes"
        return _document(self._request("POST", path, {}, document=note))

    def withdraw_note(self, motor: str, note_id: str, withdrawal: Document) -> Document:
        """Let a note count no more, and return it. Raises ServiceError."""
        path = f"{API}/motors/{segment(motor)}/notes/{segment(note_id)}/withdrawal"
        return _document(self._request("POST", path, {}, document=withdrawal))

    def restart_reference(self, motor: str, restart: Document) -> Document:
        """Have a motor's reference learnt anew, and return the note that is kept. Raises ServiceError."""
        path = f"{API}/motors/{segment(motor)}/reference"
        return _document(self._request("POST", path, {}, document=restart))

    def upload(self, motor: str, files: Mapping[str, bytes]) -> tuple[Document, bool]:
        """Store the files of one recording, and return it, and whether it is new. Raises ServiceError."""
        parts = [("files", (name, content)) for name, content in files.items()]
        response = self._request("POST", f"{API}/recordings", {}, form={"motor": motor}, files=parts)
        return _document(response), response.status_code == HTTPStatus.CREATED

    def import_report(self, motor: str, report: bytes, query: Mapping[str, str]) -> Document:
        """Have what a text report of a motor's relay tells kept; return what became of it.

        Raises ServiceError.
        """
        path = f"{API}/motors/{segment(motor)}/reports"
        headers = {b"Content-Type": b"text/plain"}
        return _document(self._request("POST", path, query, headers, content=report))

    def download(self, recording_id: str) -> tuple[str, bytes]:
        """Return the name and the content of a recording's archive. Raises ServiceError."""
        response = self._request("GET", f"{API}/recordings/{segment(recording_id)}/file", {})
        named = re.search(r'filename="([A-Za-z0-9_-][A-Za-z0-9._-]*)"', response.headers.get(DISPOSITION, ""))
        return named[1] if named else f"{segment(recording_id)}.zip", response.content

    def save(self, path: str, query: Sequence[tuple[str, str]], sink: BinaryIO) -> int:
        """Write a file that the service makes into `sink`, as it comes, and return its size in bytes.

        Raises ServiceError, also where the service broke it off; OSError of the sink.
        """
        size_bytes = 0
        address = f"{API}{path}"
        try:
            with self._http.stream("GET", address, params=list(query), timeout=FILE_TIMEOUT_S) as response:
                if not response.is_success:
                    response.read()
                    raise ServiceError(_problem(response), status=response.status_code)
                for piece in response.iter_bytes():
                    sink.write(piece)
                    size_bytes += len(piece)
        except (httpx.TransportError, httpx.UnsupportedProtocol) as error:
            if size_bytes:
                raise ServiceError(
                    f"{self._url}{address}: broken off after {size_bytes} bytes ({error}); the log of the "
                    "service says why"
                ) from error
            raise ServiceError(self._nobody(error)) from error
        return size_bytes

    def request_diagnosis(self, recording_id: str, *, method: str, model: str) -> Document:
        """Ask for another diagnosis of a recording. Raises ServiceError."""
        path = f"{API}/recordings/{segment(recording_id)}/diagnoses"
        return _document(self._request("POST", path, {}, document={"method": method, "model": model}))

    def diagnosis(self, run: Document) -> Document:
        """Return a diagnosis that was asked for, as it is now. Raises ServiceError."""
        recording, run_id = segment(str(run["recording_id"])), segment(str(run["id"]))
        return self.get(f"/recordings/{recording}/diagnoses/{run_id}")

    def set_baseline(self, motor: str, wanted: Document) -> Document:
        """Replace a motor's baseline, and return it. Raises ServiceError."""
        path = f"{API}/motors/{segment(motor)}/baseline"
        return _document(self._request("PUT", path, {}, document=wanted))

    def drop_baseline(self, motor: str, said: Mapping[str, str]) -> None:
        """Forget a motor's baseline; `said`: why and by whom. Raises ServiceError."""
        self._request("DELETE", f"{API}/motors/{segment(motor)}/baseline", said)

    def acknowledge_alarms(self, alarm_ids: Sequence[str], said: Document) -> Document:
        """Take notice of alarms; return those that were acknowledged and those refused.

        Raises ServiceError (also where none could be).
        """
        path = f"{API}/alarms/acknowledgements"
        return _document(self._request("POST", path, {}, document={"alarms": list(alarm_ids), **said}))

    def set_alarm_aside(self, alarm_id: str, how: str, wanted: Document) -> Document:
        """Set an alarm aside, and return it. `how`: "shelving" or "out-of-service". Raises ServiceError."""
        return _document(self._request("PUT", f"{API}/alarms/{segment(alarm_id)}/{how}", {}, document=wanted))

    def bring_alarm_back(self, alarm_id: str, how: str, said: Mapping[str, str]) -> Document:
        """End what `set_alarm_aside` began, and return the alarm. Raises ServiceError."""
        return _document(self._request("DELETE", f"{API}/alarms/{segment(alarm_id)}/{how}", said))

    def test_channel(self, name: str) -> Sequence[Document]:
        """Have a test sent through a channel, and return its messages. Raises ServiceError."""
        answer = _document(self._request("POST", f"{API}/notification-channels/{segment(name)}/tests", {}))
        items = answer.get("items")
        return items if isinstance(items, list) else []

    def retry_notification(self, notification_id: str) -> Document:
        """Have a message tried again that was given up, and return it. Raises ServiceError."""
        return _document(
            self._request("POST", f"{API}/notifications/{segment(notification_id)}/attempts", {})
        )

    def recording_request(self, request_id: str) -> Document:
        """Return a recording request, with its present state. Raises ServiceError."""
        return self.get(f"/event-reports/{segment(request_id)}")

    def _request(
        self,
        method: str,
        path: str,
        query: Mapping[str, str],
        headers: Mapping[bytes, bytes] | None = None,
        *,
        document: Document | None = None,
        form: Mapping[str, str] | None = None,
        files: Sequence[tuple[str, tuple[str, bytes]]] | None = None,
        content: bytes | None = None,
    ) -> httpx.Response:
        try:
            response = self._http.request(
                method,
                path,
                params=query,
                headers=headers,
                content=content,
                json=document,
                data=form,
                files=files,
            )
        except (httpx.TransportError, httpx.UnsupportedProtocol) as error:
            raise ServiceError(self._nobody(error)) from error
        if response.is_success:
            return response
        raise ServiceError(_problem(response), status=response.status_code)

    def _nobody(self, error: Exception) -> str:
        """Return in words that nothing answers."""
        return f"no service answers at {self._url} ({error}); start it with mcc serve"


def is_in_clear(url: str) -> bool:
    """Tell whether others on the network can read what is sent there."""
    parsed = urlsplit(url)
    return parsed.scheme == "http" and (parsed.hostname or "") not in ("localhost", "127.0.0.1", "::1")


def trust() -> ssl.SSLContext:
    """Return whom TLS trusts: the system's authorities (or SSL_CERT_FILE), and those of MCC_CA.

    Raises ServiceError.
    """
    context = ssl.create_default_context()
    named = os.environ.get(CA_VARIABLE, "")
    if named:
        try:
            context.load_verify_locations(named)
        except OSError as error:  # ssl.SSLError is one
            raise ServiceError(f"{CA_VARIABLE}: {named}: expected certificates (PEM): {error}") from error
    return context


def without_credentials(url: str) -> str:
    """Return a URL as it may be printed: without what is before its last @, where a password may stand."""
    return re.sub(r"(//|^).*@", r"\1", url, count=1, flags=re.DOTALL)


def segment(name: str) -> str:
    """Return a name as one segment of a path."""
    return quote(name, safe="")


def _asked(response: httpx.Response) -> str:
    return without_credentials(str(response.url))


def _document(response: httpx.Response) -> Document:
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
