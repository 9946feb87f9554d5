"""`mcc work`: real processes that take jobs of a service on one PostgreSQL database."""

import os
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest
from sqlalchemy import Engine, select
from sqlalchemy.orm import Session

from core.recordings.comtrade.writer import combined_bytes
from core.units import NANOSECONDS_PER_HOUR
from service.client.rest_client import ServiceClient
from service.condition.motor_data import document_of
from service.configuration.settings import Settings
from service.demo import MOTORS
from service.plant import read_plant
from service.recording_store.folder import FolderStore
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect
from service.storage.models import DiagnosisRow, JobRow
from service.storage.records import JobRunnerEntry
from service.storage.states import JobState
from testing.service.processes import (
    MOTOR_NAMES,
    running_service,
    service_environment,
    switched_off_plant,
)
from testing.service.real_recordings import running_record
from testing.waiting import wait_until
from tests.service.application.working import workers

RECORDINGS = 18
LEASE_S = "6"
"""Long enough for a busy machine: who is late by so much loses its jobs, though it lives."""

START_LIMIT_S = 120.0


def settings_of(directory: Path, url: str, recordings: Path) -> dict[str, str]:
    directory.mkdir(exist_ok=True)
    return {
        "MCC_SCD": str(switched_off_plant(directory)),
        "MCC_DATABASE_URL": url,
        "MCC_RECORDINGS_DIRECTORY": str(recordings),
        "MCC_WORKERS": "1",
        "MCC_LEASE_S": LEASE_S,
    }


def environment_of(directory: Path, url: str, recordings: Path) -> Mapping[str, str]:
    return service_environment(directory / "data", settings_of(directory, url, recordings))


def refusal_of(environment: Mapping[str, str]) -> str:
    """What `mcc work` says where it does not begin: one line."""
    ended = subprocess.run(
        [sys.executable, "-m", "service.cli", "work"],
        env=environment,
        capture_output=True,
        text=True,
        timeout=START_LIMIT_S,
        check=False,
    )
    assert ended.returncode == 1, ended.stderr
    (line,) = [line for line in ended.stderr.splitlines() if line.startswith("mcc: ")]
    return line


def add_recordings(repository: Repository, store: RecordingStore, first: int = 0) -> int:
    """Add some recordings that nobody has; return how many there are then, where `first` were there."""
    now_ns = time.time_ns()
    for number in range(first, first + RECORDINGS):
        record = running_record(seconds=0.3, begin_ns=now_ns - (number + 1) * NANOSECONDS_PER_HOUR)
        stored = store.store({"EVENT.CFF": combined_bytes(record, data_format="BINARY")})
        repository.add_recording(stored, motor=MOTOR_NAMES[number % len(MOTOR_NAMES)], now_ns=now_ns)
    return first + RECORDINGS


def runner_of(repository: Repository, process_id: int) -> JobRunnerEntry | None:
    return next((one for one in repository.job_runners() if one.process_id == process_id), None)


def stopped_at_work(repository: Repository, process_id: int) -> bool:
    """Stop a process, and tell whether it has a job under way; otherwise it goes on."""
    os.kill(process_id, signal.SIGSTOP)
    runner = runner_of(repository, process_id)
    if runner is not None and runner.jobs:
        return True
    os.kill(process_id, signal.SIGCONT)
    return False


@pytest.mark.timeout(600)  # a service and two hosts of workers load the numbers
def test_a_service_and_two_hosts_of_workers_diagnose_each_recording_once(
    tmp_path: Path, postgresql_url: str
) -> None:
    engine = connect(postgresql_url)
    repository = Repository(engine)
    settings = {"MCC_DATABASE_URL": postgresql_url, "MCC_WORKERS": "1", "MCC_LEASE_S": LEASE_S}
    (tmp_path / "service").mkdir()
    with running_service(tmp_path / "service", switched_off_plant(tmp_path), **settings) as service:
        recordings = service.data / "recordings"
        places = [tmp_path / name for name in ("first", "second")]
        one, other = (workers(place, settings_of(place, postgresql_url, recordings)) for place in places)
        with one as first, other as second:
            wait_until(lambda: len(repository.job_runners()) == 3, within_s=START_LIMIT_S)
            store, added = FolderStore(recordings, "tests"), [0]

            def is_stopped_at_work() -> bool:
                """Its worker may load for longer than the others', which leave it nothing to do."""
                if not repository.counts().jobs.get(JobState.QUEUED):
                    added.append(add_recordings(repository, store, added[-1]))
                return stopped_at_work(repository, first.pid)

            wait_until(is_stopped_at_work, within_s=START_LIMIT_S)
            with ServiceClient(service.url) as client:
                listed = {one["process_id"]: one for one in client.items("/job-runners")}
            assert {first.pid, second.pid, service.process_id} == set(listed)
            assert listed[first.pid]["jobs"] == 1
            taken_over = job_of(engine, str(listed[first.pid]["id"]))
            first.kill()
            first.wait()
            wait_until(lambda: repository.counts().jobs.get(JobState.DONE) == added[-1], within_s=240)
            second.terminate()
            assert second.wait(60) == 0
            assert {one.process_id for one in repository.job_runners()} == {service.process_id}
    made, attempts = results(engine)
    engine.dispose()
    assert set(made.values()) == {1}
    assert len(made) == added[-1]
    assert attempts == dict.fromkeys(attempts, 1) | {taken_over: 2}


def job_of(engine: Engine, runner: str) -> str:
    """The one job that a runner has under way."""
    under_way = select(JobRow.id).where(JobRow.runner == runner, JobRow.state == JobState.RUNNING)
    with Session(engine) as session:
        return session.scalars(under_way).one()


def results(engine: Engine) -> tuple[Counter[str], dict[str, int]]:
    """Diagnoses of each recording; attempts of each job."""
    with Session(engine) as session:
        made = Counter(session.scalars(select(DiagnosisRow.recording_id)))
        return made, {one.id: one.attempts for one in session.scalars(select(JobRow))}


def test_workers_refuse_an_sqlite_file(tmp_path: Path) -> None:
    url = f"sqlite:///{tmp_path / 'statorwatch.sqlite'}"
    line = refusal_of(environment_of(tmp_path, url, tmp_path))
    assert line.startswith("mcc: database_url: expected a PostgreSQL database, found an SQLite file")


def test_workers_refuse_a_database_without_the_service(tmp_path: Path, postgresql_url: str) -> None:
    line = refusal_of(environment_of(tmp_path, postgresql_url, tmp_path))
    assert "expected the motors that the service has, found others" in line


@pytest.mark.campaign
def test_workers_refuse_recordings_that_they_cannot_read(
    tmp_path: Path, postgresql_url: str, served_plant: Repository
) -> None:
    nothing = tmp_path / "not mounted"
    line = refusal_of(environment_of(tmp_path, postgresql_url, nothing))
    assert f"{nothing}: expected the recordings of the service, found none: mount the folder" in line
    nothing.mkdir()
    line = refusal_of(environment_of(tmp_path, postgresql_url, nothing))
    assert f"{nothing}: expected the recordings of the service, found none: mount the folder" in line
    add_recordings(served_plant, FolderStore(tmp_path / "recordings", "tests"))
    FolderStore(nothing, "another service")
    line = refusal_of(environment_of(tmp_path, postgresql_url, nothing))
    assert f"{nothing}: expected the recordings of the service, found: recording " in line


@pytest.fixture
def served_plant(tmp_path: Path, postgresql_url: str) -> Iterator[Repository]:
    """The database as a service of the demo plant leaves it."""
    settings = Settings(scd=switched_off_plant(tmp_path), motors=MOTORS)
    plant = read_plant(settings)
    engine = connect(postgresql_url)
    repository = Repository(engine)
    repository.sync_plant(plant)
    documents = {motor.name: document_of(motor.motor) for motor in plant.motors}
    repository.note_motors(documents, now_ns=time.time_ns())
    yield repository
    engine.dispose()
