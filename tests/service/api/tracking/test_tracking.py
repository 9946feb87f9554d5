"""Parameters followed while a motor runs, by REST, on its page and by `mcc drift`."""

import json

import httpx
import pytest

from core.tracking.follower import REFERENCE_RECORDS
from service.cli.app import main
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.following import PUMP, Recorder, fold_all, note_motors
from testing.service.plants import motor
from testing.service.tracked_records import tracked_records

HERE = f"/api/v1/motors/{PUMP}/parameters"
WRONG_FROM = REFERENCE_RECORDS + 5


@pytest.fixture
def drifted(repository: Repository, store: RecordingStore) -> None:
    note_motors(repository)
    records = tracked_records(motor(PUMP).parameters, WRONG_FROM + 12, wrong_from=WRONG_FROM)
    Recorder(repository, store).record_all(records)
    fold_all(repository)


@pytest.mark.usefixtures("drifted")
def test_the_document_tells_changes_causes_and_what_to_do(client: httpx.Client) -> None:
    found = client.get(HERE).raise_for_status().json()
    assert (found["motor"], found["state"], found["causes"]) == (PUMP, "drifting", ["ratio"])
    assert found["advice"].startswith("Compare ratios")
    by_name = {one["name"]: one for one in found["parameters"]}
    assert list(by_name) == [
        "stator_resistance_ohm",
        "rotor_resistance_ohm",
        "magnetising_inductance_H",
        "leakage_inductance_H",
    ]
    magnetising = by_name["magnetising_inductance_H"]
    assert magnetising["reference"] == pytest.approx(motor(PUMP).parameters.magnetising_inductance_H)
    low, high = magnetising["change_ci95"]
    assert low < 0.05 < high
    assert magnetising["since"] is not None


@pytest.mark.usefixtures("drifted")
def test_the_trend_comes_in_pages_with_intervals(client: httpx.Client) -> None:
    first = client.get(f"{HERE}/trend", params={"limit": 40}).raise_for_status().json()
    second = client.get(f"{HERE}/trend", params={"cursor": first["next_cursor"]}).raise_for_status().json()
    items = [*first["items"], *second["items"]]
    assert len(items) == WRONG_FROM + 12
    assert items[0]["magnetising_inductance"] == {"change": None, "change_ci95": None}
    latest = items[-1]["magnetising_inductance"]
    assert latest["change_ci95"][0] < latest["change"] < latest["change_ci95"][1]


def test_nothing_is_known_of_a_motor_without_records(client: httpx.Client) -> None:
    found = client.get(HERE).raise_for_status().json()
    assert (found["state"], found["parameters"], found["records"]) == ("undetermined", [], 0)
    assert client.get("/api/v1/motors/NOPE/parameters").status_code == 404


@pytest.mark.usefixtures("drifted")
def test_the_command_tells_it_in_words(client: httpx.Client, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["drift", PUMP, "--url", str(client.base_url)]) == 0
    words = capsys.readouterr().out
    assert "magnetising inductance, H" in words
    assert "drifting" in words
    assert main(["drift", PUMP, "--json", "--url", str(client.base_url)]) == 0
    assert json.loads(capsys.readouterr().out)["causes"] == ["ratio"]


@pytest.mark.usefixtures("drifted")
def test_the_command_shows_the_trend_of_a_change(
    client: httpx.Client, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["trend", PUMP, "--quantity", "magnetising_inductance_change", "--url", str(client.base_url)]
    assert main([*words, "--json"]) == 0
    points = json.loads(capsys.readouterr().out)["points"]
    assert points[0]["value"] is None
    low, high = points[-1]["ci95"]
    assert low < points[-1]["value"] < high
    assert low < 0.05 < high
    assert main([*words, "--limit", "1"]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert "magnetising inductance" in shown
    assert f" {100 * points[-1]['value']:.2f} " in shown
    assert f" [{100 * low:.2f}..{100 * high:.2f}]" in shown
