from dataclasses import asdict, replace

import httpx
import pytest

from core.machines.motor_file.reader import motor_from_table
from core.machines.stator_winding import StatorWinding, WindingKind
from service.condition.motor_data import document_of
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, SECOND_NS, fault, two_motor_plant, undiagnosable

FIRST = "2025-10-09T08:53:20.000000000Z"


@pytest.fixture
def diagnosed(repository: Repository, store: RecordingStore) -> list[str]:
    """Three recordings of PUMP-A1, a second apart."""
    ids = []
    for i, diagnosis in enumerate([fault(0.01), fault(0.02), undiagnosable()]):
        stored = store.store({f"E{i}.CFF": b"samples %d" % i})
        added = repository.add_recording(stored, motor="PUMP-A1", now_ns=NOW_NS + i)
        claimed = repository.claim_job(now_ns=NOW_NS + i, runner=RUNNER)
        assert claimed is not None
        repository.finish_job(
            claimed.job.id,
            findings_of(diagnosis),
            recorded_ns=NOW_NS + i * SECOND_NS,
            now_ns=NOW_NS + SECOND_NS,
            runner=RUNNER,
        )
        ids.append(added.recording.id)
    return ids


def test_the_plant_is_listed(client: httpx.Client) -> None:
    assert client.get("/api/v1/sites").json() == {
        "items": [{"name": "FACTORY_A", "description": "Factory A"}],
        "next_cursor": None,
    }
    motors = client.get("/api/v1/motors").json()["items"]
    assert [motor["name"] for motor in motors] == ["FAN-A2", "PUMP-A1"]
    assert client.get("/api/v1/motors/FAN-A2").json() == {**motors[0], "winding": None}


def test_pages_lead_through_the_list(client: httpx.Client) -> None:
    first = client.get("/api/v1/motors", params={"limit": 1}).json()
    second = client.get("/api/v1/motors", params={"limit": 1, "cursor": first["next_cursor"]}).json()
    assert [first["items"][0]["name"], second["items"][0]["name"]] == ["FAN-A2", "PUMP-A1"]
    assert second["next_cursor"] is None


def test_health_before_and_after_a_diagnosis(client: httpx.Client, diagnosed: list[str]) -> None:
    health = client.get("/api/v1/motors/PUMP-A1/health").json()
    assert (health["verdict"], health["reasons"], health["recording_id"]) == (
        "undiagnosable",
        ["clipped currents"],
        diagnosed[-1],
    )
    assert (health["link_state"], health["last_recording"]["name"]) == ("unknown", "E2")
    idle = client.get("/api/v1/motors/FAN-A2/health").json()
    assert (idle["verdict"], idle["reasons"], idle["last_recording"]) == (None, [], None)


def test_trend(client: httpx.Client, diagnosed: list[str]) -> None:
    url = "/api/v1/motors/PUMP-A1/trend"
    items = client.get(url).json()["items"]
    assert items[0] == {
        "time": FIRST,
        "value": 0.01,
        "ci95": [pytest.approx(0.006), pytest.approx(0.014)],
        "scatter95": [pytest.approx(0.009), pytest.approx(0.011)],
        "detection_limit": 0.021,
        "verdict": "fault",
        "recording_id": diagnosed[0],
    }
    assert [item["value"] for item in items] == [0.01, 0.02, None]
    window = {"from": items[1]["time"], "to": items[2]["time"]}
    assert client.get(url, params=window).json()["items"] == [items[1]]
    page = client.get(url, params={"limit": 2}).json()
    rest = client.get(url, params={"limit": 2, "cursor": page["next_cursor"]}).json()
    assert page["items"] + rest["items"] == items
    theta = client.get(url, params={"quantity": "theta_f"}).json()["items"]
    assert [(item["value"], item["ci95"]) for item in theta] == [(1, None), (1, None), (None, None)]
    load = client.get(url, params={"quantity": "load_level"}).json()["items"][0]
    assert (load["ci95"], load["scatter95"], load["detection_limit"]) == ([0.46, 0.5], None, None)


def test_recordings_of_a_motor_latest_first(client: httpx.Client, diagnosed: list[str]) -> None:
    items = client.get("/api/v1/motors/PUMP-A1/recordings").json()["items"]
    assert [item["id"] for item in items] == diagnosed[::-1]
    assert client.get("/api/v1/motors/FAN-A2/recordings").json()["items"] == []
    assert client.get("/api/v1/recordings", params={"motor": "PUMP-A1"}).json()["items"] == items
    assert client.get("/api/v1/recordings", params={"state": "failed"}).json()["items"] == []


def test_a_motor_tells_its_stator_winding(client: httpx.Client, repository: Repository) -> None:
    (pump, _) = two_motor_plant().motors
    assert client.get("/api/v1/motors/PUMP-A1").json()["winding"] is None
    for winding in (StatorWinding(WindingKind.LAP, 36, 2, 8), None):
        told = replace(pump.motor, winding=winding)
        repository.note_motors({pump.name: document_of(told)}, now_ns=1)
        expected = None if winding is None else {**asdict(winding), "kind": "lap"}
        assert client.get("/api/v1/motors/PUMP-A1").json()["winding"] == expected


def test_a_motor_with_nothing_but_a_nameplate_asks_to_be_commissioned(
    client: httpx.Client, repository: Repository
) -> None:
    plant = two_motor_plant()
    pump, fan = plant.motors
    bare = motor_from_table({"nameplate": asdict(pump.motor.nameplate)}, name=pump.name, source="motors.toml")
    repository.sync_plant(replace(plant, motors=(replace(pump, motor=bare), fan)))
    sources = {one["name"]: one["parameters_source"] for one in client.get("/api/v1/motors").json()["items"]}
    assert sources == {"PUMP-A1": "typical", "FAN-A2": "given"}
    for path in ("health", "condition"):
        told = client.get(f"/api/v1/motors/PUMP-A1/{path}").json()
        condition = told["condition"] if path == "health" else told
        assert condition["state"] == "unknown"
        assert condition["advice"].startswith("collecting; commission me")
        assert condition["reasons"][0].startswith("collecting; commission me")
    assert client.get("/api/v1/motors/PUMP-A1/health").json()["parameters_source"] == "typical"
    other = client.get("/api/v1/motors/FAN-A2/health").json()["condition"]
    assert "commission" not in other["advice"]
