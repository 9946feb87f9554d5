"""`mcc delete` against the API on a real port."""

import json
from pathlib import Path

import pytest

from service.api import ApiContext, create_app
from service.cli.app import main
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.plants import NOW_NS
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]


def test_a_recording_is_deleted_with_a_reason(
    repository: Repository, store: RecordingStore, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ids = [
        repository.add_recording(
            store.store({"U.CFF": bytes([number])}), motor="PUMP-A1", now_ns=NOW_NS
        ).recording.id
        for number in range(2)
    ]
    app = create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))
    with serving(app) as client:
        where = ["--url", str(client.base_url)]
        assert main(["delete", ids[0], "--reason", "wrong motor", *where]) == 0
        assert capsys.readouterr().out.endswith(f"PUMP-A1: recording U ({ids[0]}) is deleted\n")
        assert main(["delete", ids[1], "--reason", "wrong motor", "--json", *where]) == 0
        shown = capsys.readouterr().out
        document = json.loads(shown[shown.index("{") :])
        assert (document["id"], document["reason"]) == (ids[1], "wrong motor")
        assert main(["delete", ids[1], "--reason", "again", *where]) == 1
        assert "there is no recording" in capsys.readouterr().err
        assert main(["delete", ids[1], *where]) == 2
    assert repository.recordings(limit=1).items == ()
