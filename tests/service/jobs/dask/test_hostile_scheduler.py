"""A scheduler that sends pickles runs nothing on the service's host, whatever message they are in."""

import json
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import CancelledError
from contextlib import contextmanager
from pathlib import Path

import pytest

from service.jobs.dask_workers import DaskWorkers, UnusableClusterError
from service.jobs.task import Outcome, Rejected
from service.jobs.workers import WorkerFailedError
from service.recording_store.folder import FolderStore
from testing.service.hostile_scheduler import ATTACKS, HONEST

PATIENCE_S = 60.0
BEFORE_IT_BEGINS = {
    "handshake", "identity", "stream", "uncaught error", "failure of a worker", "error of a worker",
    "description",
}  # fmt: skip
BESIDE_A_RESULT = {"warning", "type of a result"}
REJECTED = json.dumps({"rejected": {"reason": "no such motor"}})

pytestmark = pytest.mark.timeout(3 * PATIENCE_S)

TRUSTING_CLIENT = """
import sys
from contextlib import suppress
from distributed import Client
client = Client(sys.argv[1], timeout=5)
with suppress(Exception):
    client.nthreads()
with suppress(Exception):
    client.run(len, "")
with suppress(Exception):
    client.submit(len, "", pure=False).result(5)
"""
"""What Dask's documentation has people do."""


@contextmanager
def scheduler(attack: str, made: Path, text: str = "") -> Iterator[str]:
    command = [sys.executable, "-m", "testing.service.hostile_scheduler", attack, str(made), text]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        try:
            yield process.stdout.readline().strip()
        finally:
            process.kill()


def unused(task: str) -> Outcome:
    raise AssertionError(f"{task} is for workers")


def outcome_at(address: str, folder: Path) -> Outcome:
    with DaskWorkers.of_scheduler(address, FolderStore(folder), None) as workers:
        return workers.schedule(unused, "a task", PATIENCE_S).result(PATIENCE_S)


@pytest.mark.parametrize("attack", ATTACKS)
def test_no_pickle_of_a_scheduler_is_read_as_an_object(tmp_path: Path, attack: str) -> None:
    made = tmp_path / "made"
    with scheduler(attack, made, REJECTED) as address:
        try:
            outcome: object = outcome_at(address, tmp_path)
        except (UnusableClusterError, WorkerFailedError, CancelledError) as error:
            outcome = error
    assert not made.exists()
    if attack in BEFORE_IT_BEGINS:
        assert isinstance(outcome, UnusableClusterError)
    elif attack in BESIDE_A_RESULT:
        assert outcome == Rejected("no such motor")
    else:
        assert isinstance(outcome, WorkerFailedError | CancelledError)


def test_a_scheduler_that_sends_no_pickle_is_used(tmp_path: Path) -> None:
    with scheduler(HONEST, tmp_path / "made", REJECTED) as address:
        assert outcome_at(address, tmp_path) == Rejected("no such motor")


@pytest.mark.campaign
@pytest.mark.parametrize("attack", ATTACKS)
def test_a_client_that_trusts_its_scheduler_runs_the_pickle(tmp_path: Path, attack: str) -> None:
    """The attacks of the other test do work."""
    made = tmp_path / "made"
    with scheduler(attack, made) as address:
        trusting = [sys.executable, "-c", TRUSTING_CLIENT, address]
        subprocess.run(trusting, timeout=PATIENCE_S, check=False, capture_output=True)
    assert made.exists()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "answer: Invalid JSON"),
        ("[]", "answer: Input should be an object"),
        ('{"run": "this"}', "run: Unexpected keyword argument"),
        ('{"rejected": {"reason": 7}}', "rejected.reason: Input should be a valid string, found 7"),
        ('{"rejected": {"reason": "no", "more": 1}}', "rejected.more: Unexpected keyword argument"),
        ('{"diagnosed": {}}', "diagnosed.findings: Field required"),
        ('{"failed": "disk \\u001b[31m full"}', "disk"),
    ],
)
def test_another_answer_than_an_outcome_fails_the_job(tmp_path: Path, text: str, said: str) -> None:
    with (
        scheduler(HONEST, tmp_path / "made", text) as address,
        pytest.raises(WorkerFailedError) as failure,
    ):
        outcome_at(address, tmp_path)
    assert said in str(failure.value)
    assert str(failure.value).isprintable()
