"""Uploads beside one another: few at a time, none so slow that it keeps the others out."""

import socket
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from urllib.parse import urlsplit

import httpx
import pytest

from service.api import ApiContext, create_app
from service.api.limits.admission import Admission
from service.api.limits.arrivals import ARRIVING_AT_ONCE
from service.recording_store.recording import StoredRecording
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.errors import FolderGoneError
from service.storage.repository.recordings.recordings import AddedRecording
from testing.service.small_record import CFG, DAT
from testing.waiting import wait_until
from tests.service.api.serving import serving

UPLOAD = "/api/v1/recordings"
HEADERS = {"Content-Type": "multipart/form-data; boundary=b"}
BEGINNING = b'--b\r\nContent-Disposition: form-data; name="files"; filename="E.CFF"\r\n\r\n'


def upload(client: httpx.Client) -> httpx.Response:
    files = [("files", ("C_0001.CFG", CFG)), ("files", ("C_0001.DAT", DAT))]
    return client.post(UPLOAD, data={"motor": "PUMP-A1"}, files=files)


@contextmanager
def begun(client: httpx.Client) -> Iterator[socket.socket]:
    """An upload of which only the beginning has come."""
    address = urlsplit(str(client.base_url))
    with socket.create_connection((address.hostname or "", address.port or 0), timeout=10) as connection:
        header = f"POST {UPLOAD} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 100000\r\n"
        header += f"Content-Type: {HEADERS['Content-Type']}\r\n"
        header += f"Authorization: {client.headers['authorization']}\r\n\r\n"
        connection.sendall(header.encode() + BEGINNING)
        yield connection


def test_uploads_that_dribble_do_not_keep_others_out(
    context: ApiContext, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("service.api.limits.arrivals.CROWDED_GRACE_S", 0.2)
    with serving(create_app(context)) as client, ExitStack() as held:
        for _ in range(2 * ARRIVING_AT_ONCE):
            held.enter_context(begun(client))
        for _ in range(3):
            assert upload(client).status_code in (200, 201)


def test_an_upload_that_is_too_slow_on_average_is_given_up(
    context: ApiContext, repository: Repository, store: RecordingStore
) -> None:
    settings = context.settings.model_copy(update={"transfer_timeout_s": 0.2, "min_upload_rate": 1_000_000})
    goes_on = threading.Event()

    def slow() -> Iterator[bytes]:
        yield BEGINNING
        for _ in range(10):
            yield b"x" * (1 << 14)
            goes_on.wait(0.1)

    with serving(create_app(replace(context, settings=settings))) as client:
        refused = client.post(UPLOAD, content=slow(), headers=HEADERS)
        assert refused.status_code == 408
        assert "min_upload_rate" in refused.json()["detail"]
        assert upload(client).status_code == 201


def test_uploads_that_arrive_wait_for_one_another(
    context: ApiContext, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("service.api.limits.arrivals.ARRIVAL_WAIT_S", 0.2)
    monkeypatch.setattr("service.api.limits.arrivals.CROWDED_GRACE_S", 60.0)
    with serving(create_app(context)) as client:
        with ExitStack() as held:
            for _ in range(ARRIVING_AT_ONCE):
                held.enter_context(begun(client))
            wait_until(lambda: upload(client).status_code == 503)
            assert int(upload(client).headers["retry-after"]) > 0
            assert client.get("/api/v1/motors").status_code == 200
        wait_until(lambda: upload(client).status_code in (200, 201))


def test_more_uploads_than_are_stored_at_a_time_are_to_be_sent_again(context: ApiContext) -> None:
    none_more = replace(context, uploads=Admission("uploads", 0, wait_s=0.01))
    with serving(create_app(none_more)) as client:
        refused = upload(client)
        assert refused.status_code == 503
        assert refused.headers["content-type"] == "application/problem+json"
        assert int(refused.headers["retry-after"]) > 0
        assert client.get("/api/v1/motors").status_code == 200


@pytest.mark.parametrize("media_type", ["application/x-www-form-urlencoded", "application/json", None])
def test_an_upload_that_is_no_form_with_files_is_refused_before_it_comes(
    client: httpx.Client, media_type: str | None
) -> None:
    headers = {} if media_type is None else {"Content-Type": media_type}
    refused = client.post(UPLOAD, content=b"&" * 150_000, headers=headers)
    assert refused.status_code == 415
    assert refused.headers["content-type"] == "application/problem+json"
    assert "expected multipart/form-data" in refused.json()["detail"]


def test_an_upload_whose_folder_goes_twice_is_to_be_sent_again(
    client: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Deletions of the same content come between, twice."""

    def gone(self: Repository, stored: StoredRecording, **_: object) -> AddedRecording:
        raise FolderGoneError(stored.digest)

    with monkeypatch.context() as deleting:
        deleting.setattr(Repository, "add_recording", gone)
        refused = upload(client)
    assert refused.status_code == 503
    assert int(refused.headers["retry-after"]) > 0
    assert upload(client).status_code == 201
