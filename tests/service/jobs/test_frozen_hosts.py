"""Locks that are held without end on PostgreSQL: by a host that stands still, by a person who forgot."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest
from sqlalchemy import Engine, func, select, text
from sqlalchemy.orm import Session

from service.recording_store.folder import FolderStore
from service.storage import Repository, connect
from service.storage.models import DiagnosisRow, JobRunnerRow
from service.storage.states import JobState
from service.storage.transaction_limits import TransactionLimits
from testing.waiting import wait_until
from tests.service.jobs.running import LIMITS, add, ended, running

pytestmark = pytest.mark.parametrize("database_url", ["postgresql"], indirect=True)

LEASE_S = 4.0
"""The server ends a host's transaction that stands still for a third of this."""

START_LIMIT_S = 120.0
"""For a process and its worker, on a busy machine."""

RENEWALS = 5
"""More than a lease has."""

ROW = text("SELECT id FROM job_runners WHERE process_id = :process_id FOR UPDATE")
WAIT_FOR_US = text(
    "SELECT count(*) FROM pg_locks WHERE NOT granted AND pg_backend_pid() = ANY (pg_blocking_pids(pid))"
)


@contextmanager
def host(url: str, recordings: Path, log: Path) -> "Iterator[subprocess.Popen[bytes]]":
    arguments = [url, str(recordings), "frozen", str(LEASE_S)]
    command = [sys.executable, "-m", "tests.service.jobs.host", *arguments]
    with log.open("wb") as to, subprocess.Popen(command, stdin=subprocess.PIPE, stderr=to) as process:
        try:
            yield process
        finally:
            process.send_signal(signal.SIGCONT)
            assert process.stdin is not None
            process.stdin.close()
            assert process.wait(60) == 0


def freeze_in_a_transaction(engine: Engine, process_id: int) -> None:
    """Stop a process while it renews the lease of its job runner, with the row's lock in its hands."""
    with engine.connect() as ours:
        ours.execute(ROW, {"process_id": process_id}).one()
        wait_until(lambda: ours.scalar(WAIT_FOR_US), "the renewal to wait for us")
        os.kill(process_id, signal.SIGSTOP)
        ours.rollback()


def jobs_of(repository: Repository, process_id: int) -> int | None:
    """How many jobs a process has under way; None where it has no runner."""
    return next((one.jobs for one in repository.job_runners() if one.process_id == process_id), None)


@pytest.mark.campaign
@pytest.mark.timeout(400)
def test_a_host_frozen_inside_a_transaction_loses_its_job_and_goes_on_when_it_wakes(
    repository: Repository, store: FolderStore, engine: Engine, database_url: str, tmp_path: Path
) -> None:
    log = tmp_path / "log"
    taken_over = add(repository, store, "hang once")
    with host(database_url, store.root, log) as frozen:
        wait_until(lambda: jobs_of(repository, frozen.pid) == 1, "the host to have the job", START_LIMIT_S)
        freeze_in_a_transaction(engine, frozen.pid)
        with running(repository, store, replace(LIMITS, lease_s=LEASE_S), installation="other"):
            wait_until(lambda: ended(repository, taken_over), "the other host to take over")
        assert jobs_of(repository, frozen.pid) is None
        frozen.send_signal(signal.SIGCONT)
        later = add(repository, store, "fine")
        wait_until(lambda: ended(repository, later), "the host to work again")
    with Session(engine) as session:
        made = session.scalars(select(DiagnosisRow.recording_id)).all()
    assert sorted(made) == sorted([taken_over, later])
    (found,) = repository.jobs(taken_over, limit=5).items
    assert found.job.attempts == 2
    told = [json.loads(line)["event"] for line in log.read_text().splitlines()]
    assert told.count("begins anew without its jobs") == 1
    assert [one for one in told if one.startswith("this process stood still inside a transaction")]


def test_a_lock_that_somebody_forgot_costs_no_runner_its_lease(
    repository: Repository, store: FolderStore, engine: Engine, database_url: str
) -> None:
    waiting = connect(database_url, limits=TransactionLimits.of_lease(LEASE_S))
    recording_id = add(repository, store, "fine")
    with engine.connect() as forgotten:
        forgotten.exec_driver_sql("SELECT FROM motors WHERE name = 'PUMP-A1' FOR UPDATE")
        with running(Repository(waiting), store, replace(LIMITS, lease_s=LEASE_S)):
            wait_until(lambda: renewals_of(engine) >= RENEWALS, "the runner to renew its lease meanwhile")
            assert not ended(repository, recording_id)
            forgotten.rollback()
            wait_until(lambda: ended(repository, recording_id), "the result to be stored")
    waiting.dispose()
    (found,) = repository.jobs(recording_id, limit=5).items
    assert (found.job.state, found.job.attempts) == (JobState.DONE, 1)


def renewals_of(engine: Engine) -> int:
    """How often the runner has renewed its lease; that of the fixture never does."""
    with Session(engine) as session:
        return session.scalar(select(func.max(JobRunnerRow.renewals))) or 0
