"""A full disk is 503 with words, wherever an upload meets it, and the same upload succeeds later."""

from collections.abc import MutableMapping
from pathlib import Path
from typing import Any

import httpx
import pytest

from service.api import ApiContext, create_app
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.no_room import no_room
from testing.service.small_record import CFG, DAT
from tests.service.api.serving import serving

SPOOLED_BYTES = 1 << 20
"""A larger file of an upload goes to the temporary folder while it arrives."""


@pytest.mark.parametrize("surplus", [0, SPOOLED_BYTES])
def test_an_upload_that_finds_no_room(
    surplus: int,
    tmp_path: Path,
    repository: Repository,
    store: RecordingStore,
    logs: list[MutableMapping[str, Any]],
) -> None:
    files = [
        ("files", ("C_0001.CFG", CFG)),
        ("files", ("C_0001.DAT", DAT)),
        ("files", ("C_0001.HDR", b"x" * (surplus + 1))),
    ]
    context = ApiContext(Settings(data_directory=tmp_path), repository, store)
    with serving(create_app(context)) as client:
        with no_room():
            response = _upload(client, files)
        assert response.status_code == 503, response.text
        assert response.headers["content-type"] == "application/problem+json"
        assert int(response.headers["retry-after"]) > 0
        assert "no room on the disk" in response.json()["detail"]
        assert client.get("/api/v1/recordings").json()["items"] == []
        assert _upload(client, files).status_code == 201
    assert [entry["event"] for entry in logs if entry["log_level"] == "error"] == ["the disk is full"]


def _upload(client: httpx.Client, files: list[tuple[str, tuple[str, bytes]]]) -> httpx.Response:
    return client.post("/api/v1/recordings", data={"motor": "PUMP-A1"}, files=files)
