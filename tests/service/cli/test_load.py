"""`mcc load` against the API on a real port."""

import json
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import httpx
import pytest

from core.relay_reports import read_motor_statistics
from service.api import ApiContext, create_app
from service.cli.app import main
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Actor
from testing.service.metered_days import meter_a_day
from testing.service.rotor_and_supply import SUPPLY, ExaminedRecordings
from tests.core.relay_reports.examples import MOT
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]


@pytest.fixture
def client(repository: Repository, store: RecordingStore, tmp_path: Path) -> Iterator[httpx.Client]:
    with serving(create_app(ApiContext(Settings(data_directory=tmp_path), repository, store))) as client:
        yield client


def test_load_in_words_and_as_json(
    client: httpx.Client, repository: Repository, capsys: pytest.CaptureFixture[str]
) -> None:
    meter_a_day(repository)

    assert main(["load", "PUMP-A1", "--url", str(client.base_url)]) == 0
    words = capsys.readouterr().out
    assert "15 h" in words
    assert "at least 1" in words
    assert "voltage below 90 %" in words
    assert "frequency below 98 %" in words
    assert "HVF" not in words
    assert "K above ambient" in words

    assert main(["load", "PUMP-A1", "--days", "7", "--json", "--url", str(client.base_url)]) == 0
    assert json.loads(capsys.readouterr().out)["standing_hours"] == 6.0


def test_records_beyond_limits(
    client: httpx.Client,
    repository: Repository,
    store: RecordingStore,
    capsys: pytest.CaptureFixture[str],
) -> None:
    meter_a_day(repository)
    distorted = replace(SUPPLY, thd_voltage=0.093)
    ExaminedRecordings(repository, store).add(None, distorted, at_ns=time.time_ns() - 1_000_000_000)

    assert main(["load", "PUMP-A1", "--url", str(client.base_url)]) == 0
    rows = [" ".join(line.split()) for line in capsys.readouterr().out.splitlines()]
    assert "THD of the voltage above 8 % 1 1 100.0 % 0.0930" in rows
    assert "HVF above 0.02 0 1 0.0 % 0.0085" in rows


def test_the_relay_s_own_statistics(
    client: httpx.Client, repository: Repository, capsys: pytest.CaptureFixture[str]
) -> None:
    meter_a_day(repository)
    told = read_motor_statistics(MOT)
    repository.add_relay_statistics("PUMP-A1", told, by=Actor("ada", "tests"), now_ns=1)
    assert main(["load", "PUMP-A1", "--url", str(client.base_url)]) == 0
    output = " ".join(capsys.readouterr().out.split())
    assert "17; counted here: 0" in output
    assert "overcurrent 1" in output
    assert "has measured nothing in that time" in output


def test_a_motor_of_which_nothing_is_known(client: httpx.Client, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["load", "FAN-A2", "--url", str(client.base_url)]) == 0
    assert "15 h" not in capsys.readouterr().out
    assert main(["load", "NOPE", "--url", str(client.base_url)]) == 1
