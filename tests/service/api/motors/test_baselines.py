"""A motor's baseline over the API, down to what a worker is given."""

from dataclasses import replace
from itertools import count
from pathlib import Path
from uuid import uuid4

import httpx
import pytest

from core.condition.kinds import Kind, State
from core.condition.observation import Observation
from core.diagnosis.baseline import Baseline
from core.diagnosis.stator import diagnose, learn_baseline
from core.diagnosis.verdict import Diagnosis, Verdict
from service.recording_store.folder import FolderStore
from service.storage import Repository
from service.storage.records import ConditionPoint, FoldResult
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import Fault, recording, running
from testing.service.accounts import TESTER
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.observations import observation
from testing.service.plants import NOW_NS, SECOND_NS, healthy, undiagnosable, watch

BASELINE = "/api/v1/motors/PUMP-A1/baseline"
NOTES = "/api/v1/motors/PUMP-A1/notes"
NO_BASELINE: dict[str, object] = {
    "recordings": [],
    "chosen_time": None,
    "reason": None,
    "by": None,
    "on_behalf_of": None,
    "doubts": [],
}


class Plant:
    """Puts recordings into the database, each with contents of its own."""

    def __init__(self, repository: Repository, store: FolderStore) -> None:
        self._repository, self._store, self._numbers = repository, store, count()

    def recording(
        self,
        diagnosis: Diagnosis | None = None,
        *,
        motor: str = "PUMP-A1",
        observation: Observation | None = None,
    ) -> str:
        number = next(self._numbers)
        stored = self._store.store({f"E{number}.CFF": b"record %d" % number})
        added = self._repository.add_recording(stored, motor=motor, now_ns=NOW_NS + number).recording
        if diagnosis is not None:
            claimed = self._repository.claim_job(now_ns=2**62, runner=RUNNER)
            assert claimed is not None
            recorded_ns = NOW_NS - number * SECOND_NS
            self._repository.finish_job(
                claimed.job.id,
                findings_of(diagnosis, observation=observation),
                recorded_ns=recorded_ns,
                now_ns=NOW_NS,
                runner=RUNNER,
            )
        return added.id


def fold(repository: Repository, recording_id: str, state: State, kind: Kind) -> None:
    """Have the motor's condition be this at the recording, and healthy at the others."""
    given = repository.begin_fold("PUMP-A1", 100)
    assert given is not None
    points = [
        ConditionPoint(
            recording_id=one.recording_id,
            time_ns=one.observation.time_ns,
            state=state if one.recording_id == recording_id else State.HEALTHY,
            kind=kind if one.recording_id == recording_id else Kind.NONE,
        )
        for one in given.observations
    ]
    assert repository.finish_fold(given, FoldResult(points, [], [], [], None), now_ns=NOW_NS)


@pytest.fixture
def plant(repository: Repository, store: FolderStore) -> Plant:
    return Plant(repository, store)


def test_a_motor_has_no_baseline_until_it_is_given_one(client: httpx.Client, plant: Plant) -> None:
    assert client.get(BASELINE).json() == NO_BASELINE
    ids = [plant.recording(healthy()) for _ in range(4)]
    answer = client.put(BASELINE, json={"recording_ids": ids[:3]})
    assert answer.status_code == 200
    assert [one["id"] for one in answer.json()["recordings"]] == ids[2::-1], "oldest first"
    client.put(BASELINE, json={"recording_ids": ids[1:]})
    assert [one["id"] for one in client.get(BASELINE).json()["recordings"]] == ids[:0:-1]
    assert client.delete(BASELINE).status_code == 204
    assert client.get(BASELINE).json() == NO_BASELINE
    assert client.get(f"/api/v1/recordings/{ids[1]}").status_code == 200


def test_who_deletes_a_baseline_and_why_is_kept(client: httpx.Client, plant: Plant) -> None:
    ids = [plant.recording(healthy()) for _ in range(3)]
    assert client.delete(BASELINE).status_code == 204
    assert client.get(NOTES).json()["items"] == [], "there was none"
    said = {"reason": "one of them showed a fault", "on_behalf_of": "A. Miller"}
    for query in ({}, said):
        client.put(BASELINE, json={"recording_ids": ids})
        assert client.delete(BASELINE, params=query).status_code == 204
        assert client.get(BASELINE).json() == NO_BASELINE
    told, silent = client.get(NOTES).json()["items"]
    assert told["text"] == "baseline of 3 recordings deleted: one of them showed a fault"
    assert (told["kind"], told["by"], told["on_behalf_of"]) == ("note", TESTER, "A. Miller")
    assert (silent["text"], silent["by"]) == ("baseline of 3 recordings deleted", TESTER)
    assert silent["time"] == silent["made_time"] < told["time"]
    client.put(BASELINE, json={"recording_ids": ids})
    for wrong in ({"reason": " "}, {"on_behalf_of": "A.\nMiller"}):
        assert client.delete(BASELINE, params=wrong).status_code == 422
    assert len(client.get(BASELINE).json()["recordings"]) == 3


def test_a_worker_is_given_the_baselines_files(
    client: httpx.Client, plant: Plant, repository: Repository, store: FolderStore
) -> None:
    ids = [plant.recording(healthy()) for _ in range(3)]
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
    good = [plant.recording(healthy()) for _ in range(3)]
    client.put(BASELINE, json={"recording_ids": good})
    refused, others = plant.recording(undiagnosable()), plant.recording(healthy(), motor="FAN-A2")
    waiting = plant.recording()
    for wrong, status, reason in (
        (refused, 409, "the diagnosis refused it"),
        (waiting, 409, "it is fetched, not diagnosed"),
        (others, 404, "there is no recording of motor PUMP-A1"),
        (str(uuid4()), 404, "there is no recording of motor PUMP-A1"),
        (good[0], 422, "at least 3 different ones, found 2"),
    ):
        answer = client.put(BASELINE, json={"recording_ids": [*good[:2], wrong]})
        assert answer.status_code == status
        assert reason in answer.json()["detail"]
    assert [one["id"] for one in client.get(BASELINE).json()["recordings"]] == good[::-1]


def test_a_motor_with_shorted_turns_is_not_its_own_baseline_without_a_reason(
    client: httpx.Client, plant: Plant
) -> None:
    """What it hides: the fault becomes a hint, as the last line shows."""
    short = Fault(0.06, 1)
    records = [recording(running(REFERENCE, load, fault=short), noise=0.003) for load in (0.4, 0.6, 0.8)]
    ids = [plant.recording(diagnose(record, REFERENCE)) for record in records]
    refused = client.put(BASELINE, json={"recording_ids": ids})
    assert refused.status_code == 409
    assert refused.headers["content-type"] == "application/problem+json"
    assert "3 of 3 recordings are in doubt" in refused.json()["detail"]
    assert "for health (reason)" in refused.json()["detail"]
    named = {each["location"]: each["message"] for each in refused.json()["errors"]}
    assert named.keys() == {f"body.recording_ids.{one}" for one in ids}
    assert all("its verdict is fault: 5." in message and "phase b" in message for message in named.values())
    assert client.get(BASELINE).json() == NO_BASELINE
    hidden = diagnose(records[1], REFERENCE, baseline=learn_baseline(records, REFERENCE))
    assert hidden.verdict is not Verdict.FAULT


def test_a_reason_is_kept_with_who_gave_it_and_when(client: httpx.Client, plant: Plant) -> None:
    doubtful, good = plant.recording(watch()), [plant.recording(healthy()) for _ in range(2)]
    wanted = {"recording_ids": [*good, doubtful]}
    for missing in ({}, {"on_behalf_of": "A. Fitter"}):
        assert client.put(BASELINE, json=wanted | missing).status_code == 409
    reason = {"reason": "rewound in May, surge test passed", "on_behalf_of": "A. Fitter"}
    answer = client.put(BASELINE, json=wanted | reason)
    assert answer.status_code == 200
    assert answer.json() == client.get(BASELINE).json()
    assert {key: answer.json()[key] for key in reason} == reason
    assert answer.json()["chosen_time"].startswith("20")
    assert answer.json()["doubts"] == [
        {"recording_id": doubtful, "doubt": "its verdict is watch: 1.20% of the turns"}
    ]
    client.put(BASELINE, json={"recording_ids": [*good, plant.recording(healthy())]})
    assert client.get(BASELINE).json()["doubts"] == []
    (note,) = client.get(NOTES).json()["items"]
    assert note["text"] == f"baseline of 3 recordings, 1 of them in doubt: {reason['reason']}"
    assert (note["by"], note["on_behalf_of"]) == (TESTER, reason["on_behalf_of"])
    assert note["time"] == answer.json()["chosen_time"]


def test_a_recording_that_is_healthy_only_relative_to_a_baseline_is_in_doubt(
    client: httpx.Client, plant: Plant
) -> None:
    """Or a baseline accepted with a reason would make the next one, without any."""
    relative = replace(healthy(), reasons=("no shorted turns", Baseline(1j, 0.0, 0j, 3).reason))
    ids = [plant.recording(relative), *(plant.recording(healthy()) for _ in range(2))]
    refused = client.put(BASELINE, json={"recording_ids": ids})
    assert refused.status_code == 409
    assert [each["location"] for each in refused.json()["errors"]] == [f"body.recording_ids.{ids[0]}"]
    assert "only relative to the baseline" in refused.json()["errors"][0]["message"]


@pytest.mark.parametrize(
    ("state", "kind", "status"),
    [
        (State.FAULT, Kind.SHORTED_TURNS, 409),
        (State.WATCH, Kind.UNCLEAR, 409),
        (State.WATCH, Kind.VOLTAGE_CHANNEL, 200),
        (State.HEALTHY, Kind.NONE, 200),
    ],
)
def test_a_healthy_recording_of_a_motor_in_a_bad_condition_is_in_doubt(
    client: httpx.Client, plant: Plant, repository: Repository, state: State, kind: Kind, status: int
) -> None:
    ids = [plant.recording(healthy(), observation=observation(number)) for number in range(3)]
    fold(repository, ids[0], state, kind)
    answer = client.put(BASELINE, json={"recording_ids": ids})
    assert answer.status_code == status
    if status == 409:
        (error,) = answer.json()["errors"]
        assert error["message"] == f"the motor's condition was {state} ({kind}) at it"


def test_a_recording_that_the_condition_does_not_follow_yet_is_in_doubt(
    client: httpx.Client, plant: Plant, repository: Repository
) -> None:
    """Or a baseline that is set right after the diagnosis is guarded by nothing but that."""
    tells_nothing = plant.recording(healthy())
    ids = [plant.recording(healthy(), observation=observation(number)) for number in range(2)]
    wanted = {"recording_ids": [tells_nothing, *ids]}
    refused = client.put(BASELINE, json=wanted)
    assert refused.status_code == 409
    named = {each["location"]: each["message"] for each in refused.json()["errors"]}
    assert named.keys() == {f"body.recording_ids.{one}" for one in ids}
    assert all("condition at it is not known yet: ask again" in message for message in named.values())
    assert client.get(BASELINE).json() == NO_BASELINE
    fold(repository, ids[0], State.HEALTHY, Kind.NONE)
    assert client.put(BASELINE, json=wanted).status_code == 200


@pytest.mark.parametrize("method", ["GET", "PUT", "DELETE"])
def test_a_motor_nobody_knows(client: httpx.Client, method: str) -> None:
    body = {"recording_ids": [str(uuid4()) for _ in range(3)]} if method == "PUT" else None
    answer = client.request(method, "/api/v1/motors/GHOST/baseline", json=body)
    assert answer.status_code == 404
    assert "no motor 'GHOST'" in answer.json()["detail"]
