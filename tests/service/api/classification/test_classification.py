"""The one answer of a motor and of a recording, by REST."""

import httpx
import pytest

from core.classification.classification import NOTHING_SEEN
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.answers import answer_of, turns_or_joint
from testing.service.rotor_and_supply import BROKEN_ROTOR, SOUND_ROTOR, ExaminedRecordings

MOTOR = "/api/v1/motors/PUMP-A1"


@pytest.fixture
def recorded(repository: Repository, store: RecordingStore) -> ExaminedRecordings:
    return ExaminedRecordings(repository, store)


def test_a_motor_without_records_is_not_called_healthy(client: httpx.Client) -> None:
    found = client.get(f"{MOTOR}/classification").raise_for_status().json()
    assert (found["motor"], found["records"], found["is_told"]) == ("PUMP-A1", 0, False)
    assert (found["words"], found["answer"], found["probability"]) == ("not assessed", [], 0.0)


def test_a_motor_that_is_unknown_is_not_found(client: httpx.Client) -> None:
    assert client.get("/api/v1/motors/NOWHERE/classification").status_code == 404


def test_rotor_and_load_are_told_from_the_latest_records(
    client: httpx.Client, recorded: ExaminedRecordings
) -> None:
    for nats in (-2.0, 20.0, 25.0, 30.0):
        recorded.add(BROKEN_ROTOR, classification=answer_of(pulsation=nats, eccentricity=-2.0))
    found = client.get(f"{MOTOR}/classification").raise_for_status().json()
    assert found["records"] == 4
    assert set(found["answer"]) == {"rotor-asymmetry", "load-pulsation"}
    by_cause = {one["cause"]: one for one in found["likelihoods"]}
    assert by_cause["load-pulsation"]["log_likelihood_ratio"] == pytest.approx(22.5)
    assert by_cause["stator-shorted-turns"]["log_likelihood_ratio"] is None


def test_one_record_that_differs_is_not_believed(client: httpx.Client, recorded: ExaminedRecordings) -> None:
    for nats in (-2.0, -2.0, 30.0):
        recorded.add(SOUND_ROTOR, classification=answer_of(pulsation=nats))
    found = client.get(f"{MOTOR}/classification").raise_for_status().json()
    assert found["answer"] == [], "and nothing is known of the winding"
    assert found["words"] == NOTHING_SEEN


def test_a_recording_tells_what_is_not_told_apart(client: httpx.Client, recorded: ExaminedRecordings) -> None:
    of_record = recorded.add(SOUND_ROTOR, classification=turns_or_joint())
    diagnosis = client.get(f"/api/v1/recordings/{of_record}").raise_for_status().json()["diagnosis"]
    answer = diagnosis["classification"]
    assert answer["is_told"] is False
    (pair,) = answer["not_told_apart"]
    assert sorted(pair["explanations"]) == [["high-resistance-connection"], ["stator-shorted-turns"]]
    assert any("another load" in test for test in pair["tests"])
