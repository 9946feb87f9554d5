"""`mcc rediagnose --batch` in processes of its own, on real recordings, on clusters of Dask that are real."""

import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from datetime import UTC, datetime
from pathlib import Path

import pytest

from core.diagnosis.methods import DEFAULT_METHOD
from service.configuration.recordings_url import BucketPlace
from service.jobs.limits import JobLimits
from service.jobs.runner import JobRunner
from service.jobs.worker import diagnose_recording, prepare_worker
from service.storage.states import JobState
from service.timing.backoff import Backoff
from testing.relays.certificates import Identity
from testing.relays.pki import Pki
from testing.service.archive import Archive, make_archive
from testing.service.s3_server import S3Server
from testing.waiting import wait_until

MCC = (sys.executable, "-m", "service.cli", "rediagnose", "--batch")
LIMITS = JobLimits(workers=1, job_timeout_s=60.0, attempts=2, backoff=Backoff(0.01, 0.1), lease_s=30.0)
MODEL = "shorted-winding"
RECORDS = 12

PATIENCE_S = 180.0
"""Of a busy machine: each command starts several processes, which load compiled models."""

pytestmark = pytest.mark.timeout(3 * PATIENCE_S)


@pytest.fixture
def archive(tmp_path: Path) -> Iterator[Archive]:
    archive = make_archive(tmp_path, RECORDS)
    yield archive
    archive.engine.dispose()


@pytest.fixture(scope="module")
def diagnosed(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Archive]:
    """An archive whose recordings a service has diagnosed."""
    archive = make_archive(tmp_path_factory.mktemp("diagnosed"), RECORDS)
    diagnose_by_the_service(archive)
    yield archive
    archive.engine.dispose()


@pytest.fixture(scope="module")
def by_the_service(diagnosed: Archive) -> list[str]:
    """What the service stored of each recording: the same of the same in another archive."""
    return diagnosed.documents()


def start(archive: Archive, *words: str) -> "subprocess.Popen[str]":
    command = [*MCC, "--config", str(archive.config), *words]
    return subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )


def run(archive: Archive, *words: str) -> dict[str, object]:
    with start(archive, *words, "--json") as process:
        said, complained = process.communicate(timeout=PATIENCE_S)
    assert (process.returncode, complained) == (0, "")
    told: dict[str, object] = json.loads(said)
    return told


def told(to_do: int, already: int) -> dict[str, object]:
    return {"to_do": to_do, "made": to_do, "already_made": already, "failed": []}


def diagnose_by_the_service(archive: Archive) -> None:
    """Queue a diagnosis of each recording, as the API does, and have a service's runner make them."""
    repository = archive.repository
    queued = [
        repository.request_diagnosis(one, now_ns=0, method=DEFAULT_METHOD, model=MODEL)
        for one in archive.recordings
    ]
    motors = {one.name: one.motor for one in archive.plant.motors}
    runner = JobRunner(
        repository,
        archive.store,
        motors,
        diagnose_recording,
        limits=LIMITS,
        installation="service",
        prepare_worker=prepare_worker,
    )
    runner.start()
    try:
        wait_until(
            lambda: len(repository.ended_jobs([job.id for job in queued])) == RECORDS, within_s=PATIENCE_S
        )
    finally:
        runner.stop()


def test_a_batch_gives_what_the_service_gives_and_once(diagnosed: Archive, by_the_service: list[str]) -> None:
    archive = diagnosed
    now = datetime.now(UTC).isoformat()
    assert run(archive, "--model", MODEL, "--processes", "1") == told(0, RECORDS)
    assert run(archive, "--model", MODEL, "--processes", "2", "--made-before", now) == told(RECORDS, 0)
    assert archive.made() == [2] * RECORDS
    assert archive.documents() == by_the_service
    assert {json.loads(one)["verdict"] for one in by_the_service} > {"healthy"}


def test_a_batch_that_is_killed_goes_on(archive: Archive) -> None:
    with start(archive, "--model", MODEL, "--processes", "1") as process:
        wait_until(lambda: sum(archive.made()) >= 3, within_s=PATIENCE_S)
        os.kill(process.pid, signal.SIGKILL)
        process.communicate(timeout=30)
    done = sum(archive.made())
    assert 3 <= done < RECORDS
    assert run(archive, "--model", MODEL, "--processes", "1") == told(RECORDS - done, done)
    assert archive.made() == [1] * RECORDS
    jobs = [job.job for one in archive.recordings for job in archive.repository.jobs(one, limit=9).items]
    assert {job.state for job in jobs} == {JobState.DONE}


@contextmanager
def cluster(directory: Path, own: Identity | None = None) -> Iterator[tuple[str, "subprocess.Popen[str]"]]:
    """A scheduler and its worker, as people start them; the address, and the scheduler's process.

    own: their certificate, beside that of its authority; without it they speak in clear.
    """
    files: tuple[str, ...] = ()
    if own is not None:
        ca = own.certificate_file.with_name("authority.pem")
        files = (
            "--tls-ca-file",
            str(ca),
            "--tls-cert",
            str(own.certificate_file),
            "--tls-key",
            str(own.key_file),
        )
    protocol = "tcp" if own is None else "tls"
    dask = (sys.executable, "-m", "dask")
    with ExitStack() as ending:

        def begin(*words: str) -> "subprocess.Popen[str]":
            process = subprocess.Popen([*dask, *words], stderr=subprocess.PIPE, text=True, cwd=directory)
            ending.callback(_end, process)
            return process

        scheduler = begin(
            "scheduler",
            "--protocol",
            protocol,
            "--host",
            "127.0.0.1",
            "--port",
            "0",
            "--no-dashboard",
            *files,
        )
        assert scheduler.stderr is not None
        at = re.compile(rf"{protocol}://[\d.:]+")
        address = next(found[0] for line in scheduler.stderr if (found := at.search(line)))
        worker = begin("worker", address, "--nthreads", "1", "--host", "127.0.0.1", "--no-dashboard", *files)
        assert worker.stderr is not None
        assert any("Registered to" in line for line in worker.stderr)
        yield address, scheduler


def _end(process: "subprocess.Popen[str]") -> None:
    process.terminate()
    process.communicate(timeout=30)


@pytest.mark.campaign
def test_a_scheduler_that_dies_is_told_in_one_line_and_the_batch_goes_on(
    archive: Archive, tmp_path: Path
) -> None:
    with (
        cluster(tmp_path) as (address, scheduler),
        start(archive, "--scheduler", address, "--model", MODEL) as process,
    ):
        wait_until(lambda: sum(archive.made()) >= 2, within_s=PATIENCE_S)
        scheduler.kill()
        _, complained = process.communicate(timeout=PATIENCE_S)
    done = sum(archive.made())
    assert process.returncode == 1
    assert complained == (
        f"mcc: the Dask scheduler of {address} is gone: {RECORDS - done} recordings are left; start the "
        "scheduler and its workers again, and the same command goes on with them\n"
    )
    with cluster(tmp_path) as (address, _):
        assert run(archive, "--scheduler", address, "--model", MODEL) == told(RECORDS - done, done)
    assert archive.made() == [1] * RECORDS


def _secured(archive: Archive, pki: Pki, own: Identity) -> None:
    """Write the certificates for the cluster into the settings."""
    table = {"ca": pki.authority.certificate_file, "certificate": own.certificate_file, "key": own.key_file}
    lines = [f'{name} = "{file}"' for name, file in table.items()]
    archive.config.write_text("\n".join([archive.config.read_text(), "[dask]", *lines, ""]))


def test_a_cluster_is_used_over_tls_by_who_has_its_certificates(archive: Archive, tmp_path: Path) -> None:
    folder = tmp_path / "certificates"
    folder.mkdir()
    pki = Pki.make(folder)
    clear = archive.config.read_text()
    with cluster(tmp_path, pki.relay) as (address, _):
        assert address.startswith("tls://")
        for own, said in (
            (None, f"mcc: --scheduler: {address}: expected the table [dask] with ca, certificate and key"),
            (pki.alien, f"mcc: --scheduler {address}: expected the address of a Dask scheduler that runs"),
        ):
            if own is not None:
                _secured(archive, pki, own)
            with start(archive, "--scheduler", address, "--model", MODEL) as process:
                _, complained = process.communicate(timeout=PATIENCE_S)
            assert (process.returncode, complained[: len(said)]) == (1, said)
            archive.config.write_text(clear)
        _secured(archive, pki, pki.client)
        assert run(archive, "--scheduler", address, "--model", MODEL) == told(RECORDS, 0)
    assert archive.made() == [1] * RECORDS


@pytest.mark.campaign
def test_a_worker_that_sees_a_bucket_alone_gives_what_the_service_gives(
    tmp_path: Path, s3: S3Server, place: BucketPlace, by_the_service: list[str]
) -> None:
    """A task names the recording, the environment the store; it has no settings and no database."""
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    archive = make_archive(tmp_path, RECORDS, str(place))
    with cluster(elsewhere) as (address, _):
        assert run(archive, "--scheduler", address, "--model", MODEL) == told(RECORDS, 0)
    assert archive.documents() == by_the_service
    assert not (archive.settings.data_directory / "recordings").exists()
    assert len([key for key in s3.keys_of() if key.startswith(place.prefix)]) == RECORDS
    archive.engine.dispose()


def test_an_edited_motors_file_asks_for_the_service_first(archive: Archive, tmp_path: Path) -> None:
    motors = tmp_path / "motors.toml"
    text = Path(archive.settings.motors or "").read_text()
    motors.write_text(text.replace("stator_resistance_ohm = 8.4", "stator_resistance_ohm = 8.5"))
    archive.config.write_text(archive.config.read_text().replace(str(archive.settings.motors), str(motors)))
    with start(archive, "--processes", "1") as process:
        _, complained = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 1
    assert complained.startswith("mcc: motor PUMP-A1: expected the parameters that the service noted")
    assert sum(archive.made()) == 0
