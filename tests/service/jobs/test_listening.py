"""PostgreSQL tells the job runner of jobs that others queue; polls are the net under it."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event

import pytest
from sqlalchemy import Engine

from service.jobs.listening import JobListener
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.waiting import wait_until

pytestmark = pytest.mark.parametrize("database_url", ["postgresql"], indirect=True)


@contextmanager
def listening(repository: Repository) -> Iterator[Event]:
    """Set whenever the listener wakes the runner, and once as soon as it listens."""
    told = Event()
    listener = JobListener(repository, told.set)
    listener.start()
    try:
        assert told.wait(10)
        told.clear()
        yield told
    finally:
        listener.stop()


def queue(repository: Repository, store: RecordingStore) -> str:
    stored = store.store({"E.CFF": b"fine"})
    recording = repository.add_recording(stored, motor="PUMP-A1", now_ns=time.time_ns()).recording
    return recording.id


def test_a_job_that_is_queued_is_told(repository: Repository, store: RecordingStore) -> None:
    with listening(repository) as told:
        recording_id = queue(repository, store)
        assert told.wait(10)
        told.clear()
        repository.request_diagnosis(recording_id, now_ns=time.time_ns())
        assert told.wait(10)


def test_what_queues_nothing_is_not_told(repository: Repository, store: RecordingStore) -> None:
    recording_id = queue(repository, store)
    with repository.job_notices() as wait:
        repository.claim_job(now_ns=time.time_ns(), runner="a runner of the tests")
        repository.recording(recording_id)
        assert not wait(0.3)


def test_a_connection_that_is_cut_is_made_again(
    repository: Repository, store: RecordingStore, engine: Engine
) -> None:
    with listening(repository) as told:
        with engine.begin() as connection:
            connection.exec_driver_sql(
                "SELECT pg_terminate_backend(pid) FROM pg_stat_activity "
                "WHERE datname = current_database() AND query LIKE 'LISTEN%%'"
            )
        wait_until(told.is_set, "the listener to listen again", within_s=20)
        told.clear()
        queue(repository, store)
        assert told.wait(10)
