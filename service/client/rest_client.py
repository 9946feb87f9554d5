"""The client of the command line and the demo: the typed client, and who asks as `mcc login` says."""

from __future__ import annotations

import os
import re
import ssl
from collections.abc import Iterator, Mapping, Sequence
from http import HTTPStatus
from types import TracebackType
from typing import TYPE_CHECKING, BinaryIO, Self, cast

from service.client.credentials import COOKIES, CredentialsError, bearer, headers_for
from statorwatch_client import Client, ServiceError
from statorwatch_client.transport import is_in_clear, segment, without_credentials

if TYPE_CHECKING:
    from statorwatch_client import models

__all__ = [
    "Document",
    "ServiceClient",
    "ServiceError",
    "is_in_clear",
    "segment",
    "trust",
    "without_credentials",
]

API = "/api/v1"
CA_VARIABLE = "MCC_CA"
DISPOSITION = "Content-Disposition"

Document = Mapping[str, object]


class ServiceClient:
    """A client of one service. It returns documents as JSON objects; every failure is a ServiceError.

    api: every operation of the API, with types.

    anonymous: does not say who asks. token: says it; by default what the environment or `mcc login` has for
    the service. MCC_CA names a file with certificates of authorities that TLS trusts, besides the system's.
    """

    def __init__(self, url: str, *, token: str | None = None, anonymous: bool = False) -> None:
        try:
            headers = {} if anonymous else headers_for(url) if token is None else bearer(token)
        except CredentialsError as error:
            raise ServiceError(str(error)) from error
        verify = trust() if url.startswith("https:") else None
        self.api = Client(url, headers=headers, verify=verify)
        self._transport = self.api.transport

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._transport.close()

    def is_ready(self) -> bool:
        """Tell whether every part of the service works."""
        return self._transport.status("/readyz") == HTTPStatus.OK

    def what_is_not_ready(self) -> str | None:
        """Return which parts of the service do not work, and why; None where all do or nothing answers."""
        return self._transport.unready()

    def answers(self) -> bool:
        """Tell whether anything answers at the address, ready or not."""
        return self._transport.status("/healthz") is not None

    def get(self, path: str, **query: str) -> Document:
        """Get a document below /api/v1. Raises ServiceError."""
        found: Document = self._transport.document("GET", f"{API}{path}", query=query)
        return found

    def send(self, method: str, path: str, document: Document | None = None) -> Document:
        """Send a document, or none, to a path below /api/v1; return the answer, empty where it has no body.

        Raises ServiceError.
        """
        answer: Document | None = self._transport.document(method, f"{API}{path}", json=document)
        return answer or {}

    def log_in(self, name: str, password: str) -> tuple[models.Account, str]:
        """Begin a session, and return the account and the session's secret. Raises ServiceError."""
        answer = self._transport.answer("POST", f"{API}/login", json={"name": name, "password": password})
        secret = answer.cookies.get(COOKIES[self._transport.scheme])
        if secret is None:
            raise ServiceError(f"{self._transport.url}: expected the cookie of a session, found none")
        account: models.Account = answer.json()
        return account, secret

    def items(self, path: str, **query: str) -> Iterator[Document]:
        """Yield every item of a list, page after page. Raises ServiceError."""
        cursor: dict[str, str] = {}
        while True:
            page = self.get(path, **query, **cursor)
            items = page.get("items")
            if not isinstance(items, list) or not all(isinstance(item, dict) for item in items):
                raise ServiceError(f"{self._transport.url}{API}{path}: expected a list of items")
            yield from items
            following = page.get("next_cursor")
            if not isinstance(following, str):
                return
            cursor = {"cursor": following}

    def request_recording(
        self, motor: str, *, idempotency_key: str | None = None, seconds: float | None = None
    ) -> models.EventReport:
        """Request a recording of the motor; the same key again requests nothing new.

        seconds: so much, as a series of recordings that is joined; None for one. Raises ServiceError.
        """
        wanted: models.RecordingWanted | None = None if seconds is None else {"seconds": seconds}
        return self.api.request_event_report(motor, idempotency_key=idempotency_key, document=wanted)

    def release(self, relay: str) -> None:
        """End the quarantine of a relay. Raises ServiceError."""
        self.api.release_ied(relay)

    def delete_recording(self, recording_id: str, reason: str) -> models.Deletion:
        """Delete a recording, and return what the service remembers of it. Raises ServiceError."""
        self.api.delete_recording(recording_id, reason=reason)
        return self.api.get_deletion(recording_id)

    def add_note(self, motor: str, note: models.NoteRequest) -> models.Note:
        """Tell something of a motor, and return the note that is kept. Raises ServiceError."""
        return self.api.add_note(motor, document=note)

    def withdraw_note(self, motor: str, note_id: str, withdrawal: models.Withdrawal) -> models.Note:
        """Let a note count no more, and return it. Raises ServiceError."""
        return self.api.withdraw_note(motor, note_id, document=withdrawal)

    def restart_reference(self, motor: str, restart: models.RestartRequest) -> models.Note:
        """Have a motor's reference learnt anew, and return the note that is kept. Raises ServiceError."""
        return self.api.restart_reference(motor, document=restart)

    def upload(self, motor: str, files: Mapping[str, bytes]) -> tuple[models.RecordingDetails, bool]:
        """Store the files of one recording, and return it, and whether it is new. Raises ServiceError."""
        status, recording = self.api.upload_recording(motor=motor, files=files)
        return recording, status == HTTPStatus.CREATED

    def import_report(self, motor: str, report: bytes, query: Mapping[str, str]) -> Document:
        """Have what a text report of a motor's relay tells kept; return what became of it.

        Raises ServiceError.
        """
        path = f"{API}/motors/{segment(motor)}/reports"
        found: Document = self._transport.document("POST", path, query=query, text=report)
        return found

    def download(self, recording_id: str) -> tuple[str, bytes]:
        """Return the name and the content of a recording's archive. Raises ServiceError."""
        response = self._transport.answer("GET", f"{API}/recordings/{segment(recording_id)}/file")
        named = re.search(r'filename="([A-Za-z0-9_-][A-Za-z0-9._-]*)"', response.headers.get(DISPOSITION, ""))
        return named[1] if named else f"{segment(recording_id)}.zip", response.content

    def save(self, path: str, query: Sequence[tuple[str, str]], sink: BinaryIO) -> int:
        """Write a file that the service makes into `sink`, as it comes, and return its size in bytes.

        Raises ServiceError, also where the service broke it off; OSError of the sink.
        """
        values: dict[str, list[str]] = {}
        for name, value in query:
            values.setdefault(name, []).append(value)
        return self._transport.save(f"{API}{path}", sink, query=values)

    def request_diagnosis(self, recording_id: str, *, method: str, model: str) -> models.DiagnosisRun:
        """Ask for another diagnosis of a recording. Raises ServiceError."""
        wanted = cast("models.DiagnosisRequest", {"method": method, "model": model})
        return self.api.request_diagnosis(recording_id, document=wanted)

    def diagnosis(self, run: Document) -> models.DiagnosisRun:
        """Return a diagnosis that was asked for, as it is now. Raises ServiceError."""
        return self.api.get_diagnosis(str(run["recording_id"]), str(run["id"]))

    def set_baseline(self, motor: str, wanted: models.BaselineRequest) -> models.Baseline:
        """Replace a motor's baseline, and return it. Raises ServiceError."""
        return self.api.set_baseline(motor, document=wanted)

    def drop_baseline(self, motor: str, said: Mapping[str, str]) -> None:
        """Forget a motor's baseline; `said`: why and by whom. Raises ServiceError."""
        self.api.drop_baseline(motor, reason=said.get("reason"), by=said.get("by"))

    def acknowledge_alarms(self, alarm_ids: Sequence[str], said: Document) -> models.Acknowledgements:
        """Take notice of alarms; return those that were acknowledged and those refused.

        Raises ServiceError (also where none could be).
        """
        wanted = cast("models.AcknowledgementRequest", {"alarms": list(alarm_ids), **said})
        return self.api.acknowledge_alarms(document=wanted)

    def set_alarm_aside(self, alarm_id: str, how: str, wanted: Document) -> Document:
        """Set an alarm aside, and return it. `how`: "shelving" or "out-of-service". Raises ServiceError."""
        return self.send("PUT", f"/alarms/{segment(alarm_id)}/{how}", wanted)

    def bring_alarm_back(self, alarm_id: str, how: str, said: Mapping[str, str]) -> Document:
        """End what `set_alarm_aside` began, and return the alarm. Raises ServiceError."""
        path = f"{API}/alarms/{segment(alarm_id)}/{how}"
        found: Document = self._transport.document("DELETE", path, query=said)
        return found

    def test_channel(self, name: str) -> Sequence[models.Notification]:
        """Have a test sent through a channel, and return its messages. Raises ServiceError."""
        return self.api.send_test(name)["items"]

    def retry_notification(self, notification_id: str) -> models.Notification:
        """Have a message tried again that was given up, and return it. Raises ServiceError."""
        return self.api.retry_notification(notification_id)

    def recording_request(self, request_id: str) -> models.EventReport:
        """Return a recording request, with its present state. Raises ServiceError."""
        return self.api.get_event_report(request_id)


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
