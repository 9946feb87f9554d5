"""How much may wait for one motor, and how a client is told."""

from pathlib import Path

import httpx
import pytest

from service.api import ApiContext
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import RemoteRecord
from service.storage.states import JobState
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, healthy

REQUEST = "/api/v1/motors/PUMP-A1/event-reports"


@pytest.fixture
def context(repository: Repository, store: RecordingStore, tmp_path: Path) -> ApiContext:
    settings = Settings(data_directory=tmp_path, max_open_requests=3, max_queued_diagnoses=3, max_notes=3)
    return ApiContext(settings, repository, store)


def assert_told_to_wait(refused: httpx.Response, words: str) -> None:
    assert refused.status_code == 429
    assert refused.headers["content-type"] == "application/problem+json"
    assert int(refused.headers["retry-after"]) > 0
    assert words in refused.json()["detail"]
    assert "ask again when some have ended" in refused.json()["detail"]


def test_a_motor_has_so_many_open_requests(client: httpx.Client, repository: Repository) -> None:
    first = client.post(REQUEST, headers={"Idempotency-Key": "a"}).json()
    for _ in range(2):
        assert client.post(REQUEST).status_code == 202
    assert_told_to_wait(
        client.post(REQUEST), "motor PUMP-A1 has 3 recording requests that wait for their record"
    )
    assert client.post(REQUEST, headers={"Idempotency-Key": "a"}).json() == first
    assert client.post("/api/v1/motors/FAN-A2/event-reports").status_code == 202
    repository.fail_recording_request(first["id"], "no record", now_ns=NOW_NS)
    assert client.post(REQUEST).status_code == 202


def upload(client: httpx.Client, content: bytes) -> httpx.Response:
    files = {"files": ("E.CFF", content)}
    return client.post("/api/v1/recordings", data={"motor": "PUMP-A1"}, files=files)


def test_a_motor_has_so_many_queued_diagnoses(
    client: httpx.Client, repository: Repository, store: RecordingStore
) -> None:
    first = upload(client, b"0").json()
    path = f"/api/v1/recordings/{first['id']}/diagnoses"
    for _ in range(2):
        assert client.post(path).status_code == 202
    full = "motor PUMP-A1 has 3 queued diagnoses"
    assert_told_to_wait(client.post(path), full)
    assert_told_to_wait(upload(client, b"1"), full)
    assert upload(client, b"0").status_code == 200, "nothing is to be diagnosed"
    of_the_relay = repository.add_recording(
        store.store({"R.CFF": b"2"}),
        motor="PUMP-A1",
        relay="A1_SEL710",
        remote=RemoteRecord("R", 1, NOW_NS),
        now_ns=NOW_NS,
    )
    assert of_the_relay.created, "no limit keeps a relay's record out"
    assert repository.counts().jobs == {JobState.QUEUED: 4}


def test_a_motor_has_so_many_notes(client: httpx.Client) -> None:
    motor = "/api/v1/motors/PUMP-A1"
    note, restart = (
        {"text": "hums", "on_behalf_of": "A. Miller"},
        {"reason": "tested", "on_behalf_of": "A. Miller"},
    )
    kept = [client.post(f"{motor}/notes", json=note).json()["id"] for _ in range(2)]
    kept.append(client.post(f"{motor}/reference", json=restart).json()["id"])
    client.post(f"{motor}/notes/{kept[0]}/withdrawal", json=restart)
    refused = client.post(f"{motor}/notes", json=note)
    assert refused.status_code == 409
    assert refused.headers["content-type"] == "application/problem+json"
    assert "motor PUMP-A1 has 3 notes" in refused.json()["detail"]
    assert "raise the setting max_notes" in refused.json()["detail"]
    assert {one["id"] for one in client.get(f"{motor}/notes").json()["items"]} == set(kept)
    assert client.post("/api/v1/motors/FAN-A2/notes", json=note).status_code == 201


def test_no_number_of_notes_keeps_a_wrong_baseline_or_reference(
    client: httpx.Client, repository: Repository, store: RecordingStore
) -> None:
    motor = "/api/v1/motors/PUMP-A1"
    note, restart = (
        {"text": "hums", "on_behalf_of": "A. Miller"},
        {"reason": "tested", "on_behalf_of": "A. Miller"},
    )
    ids = [diagnosed(repository, store, b"%d" % number) for number in range(3)]
    for _ in range(3):
        assert client.post(f"{motor}/notes", json=note).status_code == 201
    assert client.put(f"{motor}/baseline", json={"recording_ids": ids, **restart}).status_code == 200
    assert client.delete(f"{motor}/baseline", params=restart).status_code == 204
    assert client.get(f"{motor}/baseline").json()["recordings"] == []
    assert client.post(f"{motor}/reference", json=restart).status_code == 201
    again = {**note, "kind": "reference-restarted"}
    assert client.post(f"{motor}/notes", json=again).status_code == 201
    assert len(client.get(f"{motor}/notes").json()["items"]) == 7, "they are kept"
    assert client.post(f"{motor}/notes", json=note).status_code == 409


def test_what_baselines_and_references_note_counts(
    client: httpx.Client, repository: Repository, store: RecordingStore
) -> None:
    motor = "/api/v1/motors/PUMP-A1"
    note, restart = (
        {"text": "hums", "on_behalf_of": "A. Miller"},
        {"reason": "tested", "on_behalf_of": "A. Miller"},
    )
    ids = [diagnosed(repository, store, b"%d" % number) for number in range(3)]
    client.put(f"{motor}/baseline", json={"recording_ids": ids, **restart})
    client.delete(f"{motor}/baseline")
    assert client.post(f"{motor}/notes", json=note).status_code == 201
    assert client.post(f"{motor}/notes", json=note).status_code == 409


def diagnosed(repository: Repository, store: RecordingStore, content: bytes) -> str:
    """Add a recording of the pump that is diagnosed as healthy; return its id."""
    stored = store.store({"E.CFF": content})
    added = repository.add_recording(stored, motor="PUMP-A1", now_ns=NOW_NS).recording
    claimed = repository.claim_job(now_ns=2**62, runner=RUNNER)
    assert claimed is not None
    repository.finish_job(
        claimed.job.id, findings_of(healthy()), recorded_ns=NOW_NS, now_ns=NOW_NS, runner=RUNNER
    )
    return added.id
