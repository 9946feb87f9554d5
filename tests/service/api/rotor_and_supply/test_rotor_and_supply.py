"""What recordings show of rotor and supply, by REST."""

from typing import Any

import httpx
import pytest

from core.rotor.finding import RotorState
from core.rotor.start_finding import StartSideband
from core.starts.examined import ExaminedStart
from core.time_stamps import rfc3339
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.plants import NOW_NS, SECOND_NS
from testing.service.rotor_and_supply import (
    BROKEN_ROTOR,
    ECCENTRIC_ROTOR,
    SHORT_RECORD,
    SOUND_ROTOR,
    SUPPLY,
    SWINGING_LOAD,
    ExaminedRecordings,
)
from testing.service.starts import START, RecordedStarts

MOTOR = "/api/v1/motors/PUMP-A1"
SHOWN = {"rotor": BROKEN_ROTOR.as_dict(), "supply": SUPPLY.as_dict()}


@pytest.fixture
def recorded(repository: Repository, store: RecordingStore) -> ExaminedRecordings:
    return ExaminedRecordings(repository, store)


@pytest.mark.parametrize("part", SHOWN)
def test_each_recording_is_told_with_its_time_and_id(
    client: httpx.Client, recorded: ExaminedRecordings, part: str
) -> None:
    ids = [recorded.add(BROKEN_ROTOR, SUPPLY), recorded.add(BROKEN_ROTOR, SUPPLY)]
    found = client.get(f"{MOTOR}/{part}/trend").json()
    assert found == {
        "items": [
            {**SHOWN[part], "recording_id": one, "time": rfc3339(NOW_NS + at * SECOND_NS)}
            for at, one in enumerate(ids, start=1)
        ],
        "next_cursor": None,
    }


@pytest.mark.parametrize("part", SHOWN)
def test_trends_come_in_pages_and_pieces_of_time(
    client: httpx.Client, recorded: ExaminedRecordings, part: str
) -> None:
    ids = [recorded.add(SOUND_ROTOR, SUPPLY) for _ in range(3)]

    def ask(**query: Any) -> Any:
        return client.get(f"{MOTOR}/{part}/trend", params=query).raise_for_status().json()

    first = ask(limit=2)
    second = ask(limit=2, cursor=first["next_cursor"])
    assert [one["recording_id"] for one in (*first["items"], *second["items"])] == ids
    piece = ask(**{"from": rfc3339(NOW_NS + 2 * SECOND_NS), "to": rfc3339(NOW_NS + 3 * SECOND_NS)})
    assert [one["recording_id"] for one in piece["items"]] == [ids[1]]


def test_a_record_that_cannot_tell_says_why(client: httpx.Client, recorded: ExaminedRecordings) -> None:
    recorded.add(SHORT_RECORD)
    (found,) = client.get(f"{MOTOR}/rotor/trend").json()["items"]
    assert (found["state"], found["severity_dB"]) == ("unsupported", None)
    assert found["reasons"] == ["the record is too short for this slip"]
    assert client.get(f"{MOTOR}/supply/trend").json()["items"] == []


def test_the_diagnosis_of_a_recording_has_both(client: httpx.Client, recorded: ExaminedRecordings) -> None:
    recording = recorded.add(BROKEN_ROTOR, SUPPLY)
    diagnosis = client.get(f"/api/v1/recordings/{recording}").json()["diagnosis"]
    assert {part: diagnosis[part] for part in SHOWN} == SHOWN


@pytest.mark.parametrize("part", SHOWN)
def test_there_is_no_such_motor(client: httpx.Client, part: str) -> None:
    answer = client.get(f"/api/v1/motors/PUMP-A/{part}/trend")
    assert answer.status_code == 404
    assert "PUMP-A1" in answer.json()["detail"]


def test_the_condition_of_a_rotor_follows_from_all_its_records(
    client: httpx.Client, recorded: ExaminedRecordings
) -> None:
    found = client.get(f"{MOTOR}/rotor").json()
    assert (found["motor"], found["state"], found["severity_dB"]) == ("PUMP-A1", "unsupported", None)
    assert found["advice"].startswith("Have longer recordings made")

    for finding in (SOUND_ROTOR, SOUND_ROTOR, SOUND_ROTOR, BROKEN_ROTOR, BROKEN_ROTOR):
        recorded.add(finding)
    found = client.get(f"{MOTOR}/rotor").json()
    assert (found["state"], found["severity_dB"], found["change_dB"]) == ("fault", -29.0, 21.0)
    assert found["since"] == rfc3339(NOW_NS + 5 * SECOND_NS)
    assert found["bins"] == [{"bin": 6, "records": 5, "baseline_dB": -50.0}]
    assert found["advice"].startswith("Have the cage inspected")
    assert client.get("/api/v1/motors/PUMP-A/rotor").status_code == 404


def test_a_start_stands_beside_what_the_running_motor_shows(
    client: httpx.Client, recorded: ExaminedRecordings, repository: Repository, store: RecordingStore
) -> None:
    starts = RecordedStarts(repository, store)
    assert client.get(f"{MOTOR}/rotor").json()["start"] is None
    recorded.add(BROKEN_ROTOR)
    assert client.get(f"{MOTOR}/rotor").json()["start"] is None
    broken = StartSideband(RotorState.FAULT, -28.0, (-38.0, -25.0), -45.0, 12, ("told",))
    short = StartSideband(RotorState.UNSUPPORTED, None, None, None, 1, ("too short",))
    agreeing = starts.add(ExaminedStart(START, sideband=broken))
    starts.add(ExaminedStart(START, sideband=short))
    found = client.get(f"{MOTOR}/rotor").json()["start"]
    assert (found["recording_id"], found["state"], found["agrees"]) == (agreeing, "fault", True)
    assert found["words"].startswith("both agree: running, it says fault")
    sound = StartSideband(RotorState.HEALTHY, None, None, -45.0, 12, ("none",))
    starts.add(ExaminedStart(START, sideband=sound))
    found = client.get(f"{MOTOR}/rotor").json()["start"]
    assert found["agrees"] is False
    assert "they do not agree" in found["words"]


def test_the_trend_of_air_gap_and_load(client: httpx.Client, recorded: ExaminedRecordings) -> None:
    recording = recorded.add(SOUND_ROTOR, eccentricity=ECCENTRIC_ROTOR, pulsation=SWINGING_LOAD)
    assert client.get(f"{MOTOR}/swings/trend").json() == {
        "items": [
            {
                "time": rfc3339(NOW_NS + SECOND_NS),
                "recording_id": recording,
                "eccentricity": ECCENTRIC_ROTOR.as_dict(),
                "pulsation": SWINGING_LOAD.as_dict(),
            }
        ],
        "next_cursor": None,
    }
    assert client.get("/api/v1/motors/PUMP-A/swings/trend").status_code == 404
