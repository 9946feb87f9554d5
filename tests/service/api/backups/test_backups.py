"""The back-ups as the API lists them."""

import httpx

from service.api import ApiContext
from testing.service.plants import NOW_NS, SECOND_NS


def test_the_list_says_how_each_ended(client: httpx.Client, context: ApiContext) -> None:
    first = context.repository.begin_backup("/backup", now_ns=NOW_NS, due_ns=NOW_NS)
    assert first is not None
    context.repository.finish_backup(
        first.id,
        name="backup-20251009T085320Z",
        recordings=3,
        files=8,
        size_bytes=700,
        now_ns=NOW_NS + SECOND_NS,
    )
    second = context.repository.begin_backup("/backup", now_ns=NOW_NS + 5 * SECOND_NS)
    assert second is not None
    context.repository.fail_backup(second.id, "the disk is full", now_ns=NOW_NS + 6 * SECOND_NS)
    listed = client.get("/api/v1/backups").json()["items"]
    assert [(one["state"], one["problem"]) for one in listed] == [
        ("failed", "the disk is full"),
        ("verified", None),
    ]
    assert listed[1] == {
        "id": first.id,
        "state": "verified",
        "name": "backup-20251009T085320Z",
        "directory": "/backup",
        "due_time": "2025-10-09T08:53:20.000000000Z",
        "began_time": "2025-10-09T08:53:20.000000000Z",
        "ended_time": "2025-10-09T08:53:21.000000000Z",
        "recordings": 3,
        "files": 8,
        "size_bytes": 700,
        "problem": None,
    }
    page = client.get("/api/v1/backups", params={"limit": 1}).json()
    following = client.get("/api/v1/backups", params={"limit": 1, "cursor": page["next_cursor"]}).json()
    assert [one["state"] for one in following["items"]] == ["verified"]
