"""`mcc losses` against the API on a real port, and what it costs with a price."""

import json
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from service.api import ApiContext, create_app
from service.cli.app import main
from service.configuration.energy import EnergySettings
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.metered_days import meter_a_day
from testing.service.rotor_and_supply import LOSSES, SOUND_ROTOR, SUPPLY, ExaminedRecordings
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]


@pytest.fixture
def client(repository: Repository, store: RecordingStore, tmp_path: Path) -> Iterator[httpx.Client]:
    energy = EnergySettings(price_per_kWh=0.2, currency="EUR")
    settings = Settings(data_directory=tmp_path, energy=energy)
    with serving(create_app(ApiContext(settings, repository, store))) as client:
        yield client


def test_losses_in_words_and_as_json(
    client: httpx.Client, repository: Repository, store: RecordingStore, capsys: pytest.CaptureFixture[str]
) -> None:
    recorded = ExaminedRecordings(repository, store)
    for _ in range(3):
        recorded.add(SOUND_ROTOR, SUPPLY, losses=LOSSES)

    assert main(["losses", "PUMP-A1", "--url", str(client.base_url)]) == 0
    words = capsys.readouterr().out
    assert "taken as running all the time" in words
    assert "shorted turns" in words
    assert "60 to 70 %" in words
    assert "EUR a year" in words

    assert main(["losses", "PUMP-A1", "--json", "--url", str(client.base_url)]) == 0
    found = json.loads(capsys.readouterr().out)
    turns = found["causes"][0]
    assert turns["energy_kWh_per_year"] == pytest.approx(12.5 * 8.76)
    assert turns["cost_per_year"] == pytest.approx(0.2 * 12.5 * 8.76)

    meter_a_day(repository)  # which runs fifteen hours and stands six
    found = client.get("/api/v1/motors/PUMP-A1/losses").json()
    assert found["duty"] == pytest.approx(15 / 21, abs=0.01)
    assert found["causes"][0]["cost_per_year"] == pytest.approx(0.2 * 12.5 * 8.76 * found["duty"])


def test_a_motor_without_records_says_so(client: httpx.Client, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["losses", "PUMP-A1", "--url", str(client.base_url)]) == 0
    assert "no record tells them" in capsys.readouterr().out
    assert main(["losses", "NOT-THERE", "--url", str(client.base_url)]) != 0
