"""`mcc inspections` against the API on a real port."""

import json
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from service.api import ApiContext, create_app
from service.cli.app import main
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.conditions import FAULT, tell
from testing.service.pictures import SMALL_PNG
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]


@pytest.fixture
def client(repository: Repository, store: RecordingStore, tmp_path: Path) -> Iterator[httpx.Client]:
    with serving(create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))) as client:
        yield client


def test_what_was_found_is_told_listed_counted_and_exported(
    client: httpx.Client, repository: Repository, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    tell(repository, FAULT)
    url = ["--url", str(client.base_url)]
    picture = tmp_path / "coil.png"
    picture.write_bytes(SMALL_PNG)
    told = ["inspections", "add", "PUMP-A1", "confirmed", "two turns in coil 7", "--picture", str(picture)]
    assert main([*told, "--json", *url]) == 0
    kept = json.loads(capsys.readouterr().out)
    assert (kept["kind"], kept["pictures"]) == ("shorted-turns", 1)
    assert main(["inspections", "list", "PUMP-A1", *url]) == 0
    assert "two turns in coil 7" in capsys.readouterr().out
    assert main(["inspections", "figures", *url]) == 0
    assert "shorted turns" in capsys.readouterr().out
    table = tmp_path / "inspections.csv"
    assert main(["export", "inspections", "--output", str(table), *url]) == 0
    assert "two turns in coil 7" in table.read_text(encoding="utf-8-sig")
    assert main(["inspections", "withdraw", "PUMP-A1", kept["id"], "--reason", "wrong motor", *url]) == 0
    assert "is withdrawn" in capsys.readouterr().out
    assert main(["inspections", "figures", "--json", *url]) == 0
    assert json.loads(capsys.readouterr().out)["counts"] == []


def test_a_wrong_picture_and_outcome_are_told(
    client: httpx.Client, repository: Repository, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    tell(repository, FAULT)
    wrong = ["inspections", "add", "PUMP-A1", "other-cause", "x", "--url", str(client.base_url)]
    assert main(wrong) == 1
    assert "expected what it was" in capsys.readouterr().err
    assert main([*wrong, "--picture", str(tmp_path / "none.png")]) == 1
    assert main(["inspections", "add", "PUMP-A1", "perhaps", "x"]) == 2
