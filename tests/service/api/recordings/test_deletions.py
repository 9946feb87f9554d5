"""Deleting a recording by the API, and the list of what was deleted."""

import time

import httpx
import pytest

from service.api import ApiContext
from service.recording_store.folder import FolderStore
from service.retention.deletion import remove_discarded_folders
from service.storage import Repository
from service.storage.records import Actor
from service.storage.states import DeletedBy
from service.timing.undo_time import UNDO_NS
from testing.service.accounts import TESTER
from testing.service.job_runner import RUNNER
from testing.service.plants import SECOND_NS
from tests.service.api.recordings.test_recordings import FILES, upload


@pytest.fixture
def recording(client: httpx.Client) -> str:
    return str(upload(client, FILES)[1]["id"])


def test_a_wrong_upload_is_deleted_with_its_files(
    client: httpx.Client, context: ApiContext, recording: str
) -> None:
    path = f"/api/v1/recordings/{recording}"
    answer = client.delete(path, params={"reason": " of another motor "})
    assert (answer.status_code, answer.content) == (204, b"")
    assert client.get(path).status_code == 404
    assert client.delete(path, params={"reason": "again"}).status_code == 404
    (deletion,) = client.get("/api/v1/deletions", params={"motor": "PUMP-A1"}).json()["items"]
    assert deletion == client.get(f"/api/v1/deletions/{recording}").json()
    assert (deletion["id"], deletion["motor"], deletion["name"]) == (recording, "PUMP-A1", "EVENT")
    assert (deletion["reason"], deletion["deleted_by"]) == ("of another motor", "person")
    assert len(deletion["sha256"]) == 64
    assert client.get("/api/v1/deletions", params={"motor": "FAN-A2"}).json()["items"] == []
    assert isinstance(context.store, FolderStore)
    now_ns = time.time_ns()
    remove_discarded_folders(context.repository, context.store, now_ns)
    assert [path.name for path in context.store.root.glob("??/*")] == [deletion["sha256"]], "it may be undone"
    remove_discarded_folders(context.repository, context.store, now_ns + UNDO_NS)
    assert list(context.store.root.glob("??/*")) == []
    status, document = upload(client, FILES)
    assert (status, document["id"] != recording) == (201, True), "who uploads it again means it"


@pytest.mark.parametrize("query", [{}, {"reason": ""}, {"reason": "  "}, {"reason": "x" * 501}])
def test_a_reason_is_needed(client: httpx.Client, recording: str, query: dict[str, str]) -> None:
    answer = client.delete(f"/api/v1/recordings/{recording}", params=query)
    assert answer.status_code == 422
    assert answer.json()["errors"][0]["location"] == "query.reason"
    assert client.get(f"/api/v1/recordings/{recording}").status_code == 200


def test_a_diagnosis_that_runs_is_named(client: httpx.Client, repository: Repository, recording: str) -> None:
    claimed = repository.claim_job(now_ns=2**62, runner=RUNNER)
    assert claimed is not None
    answer = client.delete(f"/api/v1/recordings/{recording}", params={"reason": "x"})
    assert answer.status_code == 409
    assert f"diagnosis {claimed.job.id} of it is running" in answer.json()["detail"]


def test_what_was_deleted_comes_in_pages(client: httpx.Client) -> None:
    ids = []
    for number in range(3):
        _, document = upload(client, {**FILES, "EVENT.DAT": bytes([number])})
        ids.append(str(document["id"]))
        client.delete(f"/api/v1/recordings/{ids[-1]}", params={"reason": "x"})
    first = client.get("/api/v1/deletions", params={"limit": 2}).json()
    second = client.get("/api/v1/deletions", params={"limit": 2, "cursor": first["next_cursor"]}).json()
    assert [item["id"] for item in first["items"] + second["items"]] == ids[::-1]
    assert second["next_cursor"] is None


def test_who_deleted_it_has_it_back_for_ten_minutes(client: httpx.Client, recording: str) -> None:
    path = f"/api/v1/recordings/{recording}"
    before = client.get(path).json()
    undo = f"/api/v1/deletions/{recording}/undo"
    assert client.post(undo).status_code == 404, "it is not deleted"
    client.delete(path, params={"reason": "a slip"})
    answer = client.post(undo)
    assert (answer.status_code, answer.json()["state"]) == (200, "fetched")
    assert client.get(path).json() == before
    assert client.get(f"{path}/file").status_code == 200
    assert client.get("/api/v1/deletions").json()["items"] == []
    assert client.post(undo).status_code == 404, "it is there"


@pytest.mark.parametrize(
    ("account", "ago_ns", "deleted_by", "why"),
    [
        ("somebody", 0, DeletedBy.PERSON, "only who deleted it may have it back"),
        (TESTER, UNDO_NS + SECOND_NS, DeletedBy.PERSON, "it is too long ago"),
        (TESTER, 0, DeletedBy.RETENTION, "a rule of retention deleted it"),
    ],
)
def test_what_cannot_be_undone_says_why(
    client: httpx.Client,
    repository: Repository,
    recording: str,
    account: str,
    ago_ns: int,
    deleted_by: DeletedBy,
    why: str,
) -> None:
    by, now_ns = Actor(account, "elsewhere"), time.time_ns() - ago_ns
    repository.delete_recording(recording, "a slip", by=by, now_ns=now_ns, deleted_by=deleted_by)
    answer = client.post(f"/api/v1/deletions/{recording}/undo")
    assert (answer.status_code, answer.headers["content-type"]) == (409, "application/problem+json")
    assert why in answer.json()["detail"]
    assert client.get(f"/api/v1/recordings/{recording}").status_code == 404
