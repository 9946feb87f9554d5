"""`mcc check --fail-on`: silent and 0 while all is well, the motors and 1 where one is not."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from service.api import ApiContext, create_app
from service.cli.app import main
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.ports import free_port
from testing.service.conditions import DRIFTING, FAULT, HEALTHY, tell
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]


@pytest.fixture
def url(repository: Repository, store: RecordingStore, tmp_path: Path) -> Iterator[str]:
    with serving(create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))) as client:
        yield str(client.base_url)


def test_motors_at_a_state_or_beyond_end_it_with_one(
    url: str, repository: Repository, capsys: pytest.CaptureFixture[str]
) -> None:
    tell(repository, HEALTHY)
    for state in ("watch", "fault"):
        assert main(["check", "--fail-on", state, "--url", url]) == 0
        assert capsys.readouterr().out == "", "cron sends a mail of every word"
    tell(repository, DRIFTING)
    assert main(["check", "--fail-on", "fault", "--url", url]) == 0
    assert main(["check", "--fail-on", "watch", "--url", url]) == 1
    assert capsys.readouterr().out.startswith("PUMP-A1: watch: voltage channel or shorted turns c")
    tell(repository, FAULT)
    for state in ("watch", "fault"):
        assert main(["check", "--fail-on", state, "--url", url]) == 1
        line = capsys.readouterr().out
        assert line.startswith("PUMP-A1: fault: shorted turns b, 1.21 % [0.90..2.25], since 2025-")
    assert main(["check", "--fail-on", "fault", "--json", "--url", url]) == 1
    document = json.loads(capsys.readouterr().out)
    assert (document["motors"], [one["motor"] for one in document["found"]]) == (2, ["PUMP-A1"])


def test_a_service_that_does_not_answer_is_no_good_news(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "--fail-on", "fault", "--url", f"http://127.0.0.1:{free_port()}"]) == 1
    assert "no service answers" in capsys.readouterr().err


def test_files_are_checked_without_a_service(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "--fail-on", "fault", "--config", "mcc.toml"]) == 2
    assert "--fail-on asks the running service" in capsys.readouterr().err
