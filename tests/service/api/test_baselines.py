"""A motor's baseline over the API, down to what a worker is given."""

from itertools import count
from pathlib import Path
from uuid import uuid4

import httpx
import pytest

from core.diagnosis.verdict import Diagnosis
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, SECOND_NS, fault, undiagnosable

BASELINE = "/api/v1/motors/PUMP-A1/baseline"


class Plant:
    """Puts recordings into the database, each with contents of its own."""

    def __init__(self, repository: Repository, store: RecordingStore) -> None:
        self._repository, self._store, self._numbers = repository, store, count()

    def recording(self, diagnosis: Diagnosis | None = None, *, motor: str = "PUMP-A1") -> str:
        number = next(self._numbers)
        stored = self._store.store({f"E{number}.CFF": b"record %d" % number})
        added = self._repository.add_recording(stored, motor=motor, now_ns=NOW_NS + number).recording
        if diagnosis is not None:
            claimed = self._repository.claim_job(now_ns=2**62, runner=RUNNER)
            assert claimed is not None
            recorded_ns = NOW_NS - number * SECOND_NS
            self._repository.finish_job(
                claimed.job.id, diagnosis, recorded_ns=recorded_ns, now_ns=NOW_NS, runner=RUNNER
            )
        return added.id


@pytest.fixture
def plant(repository: Repository, store: RecordingStore) -> Plant:
    return Plant(repository, store)


def test_a_motor_has_no_baseline_until_it_is_given_one(client: httpx.Client, plant: Plant) -> None:
    assert client.get(BASELINE).json() == {"recordings": []}
    ids = [plant.recording(fault()) for _ in range(4)]
    answer = client.put(BASELINE, json={"recording_ids": ids[:3]})
    assert answer.status_code == 200
    assert [one["id"] for one in answer.json()["recordings"]] == ids[2::-1], "oldest first"
    client.put(BASELINE, json={"recording_ids": ids[1:]})
    assert [one["id"] for one in client.get(BASELINE).json()["recordings"]] == ids[:0:-1]
    assert client.delete(BASELINE).status_code == 204
    assert client.get(BASELINE).json() == {"recordings": []}
    assert client.get(f"/api/v1/recordings/{ids[1]}").status_code == 200


def test_a_worker_is_given_the_baselines_files(
    client: httpx.Client, plant: Plant, repository: Repository, store: RecordingStore
) -> None:
    ids = [plant.recording(fault()) for _ in range(3)]
    client.put(BASELINE, json={"recording_ids": ids})
    plant.recording(motor="FAN-A2")
    of_another = repository.claim_job(now_ns=2**62, runner=RUNNER)
    assert of_another is not None
    assert of_another.baseline == ()
    plant.recording()
    claimed = repository.claim_job(now_ns=2**62, runner=RUNNER)
    assert claimed is not None
    assert [Path(store.entry(digest)).name for digest in claimed.baseline] == ["E2.CFF", "E1.CFF", "E0.CFF"]


def test_what_cannot_be_part_of_a_baseline_changes_nothing(client: httpx.Client, plant: Plant) -> None:
    good = [plant.recording(fault()) for _ in range(3)]
    client.put(BASELINE, json={"recording_ids": good})
    refused, others = plant.recording(undiagnosable()), plant.recording(fault(), motor="FAN-A2")
    waiting = plant.recording()
    for wrong, status, reason in (
        (refused, 409, "the diagnosis refused it"),
        (waiting, 409, "it is fetched, not diagnosed"),
        (others, 404, "there is no recording of motor PUMP-A1"),
        (str(uuid4()), 404, "there is no recording of motor PUMP-A1"),
        (good[0], 422, "at least 3 items"),
    ):
        answer = client.put(BASELINE, json={"recording_ids": [*good[:2], wrong]})
        assert answer.status_code == status
        assert reason in answer.json()["detail"]
    assert [one["id"] for one in client.get(BASELINE).json()["recordings"]] == good[::-1]


@pytest.mark.parametrize("method", ["GET", "PUT", "DELETE"])
def test_a_motor_nobody_knows(client: httpx.Client, method: str) -> None:
    body = {"recording_ids": [str(uuid4()) for _ in range(3)]} if method == "PUT" else None
    answer = client.request(method, "/api/v1/motors/GHOST/baseline", json=body)
    assert answer.status_code == 404
    assert "no motor 'GHOST'" in answer.json()["detail"]
