"""A job runner with real worker processes, and records for it."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from service.jobs.limits import JobLimits
from service.jobs.runner import JobRunner
from service.jobs.worker_process import follow_service
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.states import RecordingState
from service.timing.backoff import Backoff
from testing.service.plants import motor
from tests.service.jobs.stand_ins import act_as_told

LIMITS = JobLimits(workers=2, job_timeout_s=30.0, attempts=2, backoff=Backoff(0.01, 0.1), lease_s=30.0)
MOTORS = {"PUMP-A1": motor("PUMP-A1")}


@contextmanager
def running(
    repository: Repository,
    store: RecordingStore,
    limits: JobLimits = LIMITS,
    prepare_worker: Callable[[], None] = follow_service,
    installation: str = "ours",
) -> Iterator[JobRunner]:
    runner = JobRunner(
        repository,
        store,
        MOTORS,
        act_as_told,
        limits=limits,
        installation=installation,
        prepare_worker=prepare_worker,
        poll_period_s=0.05,
    )
    runner.start()
    try:
        yield runner
    finally:
        runner.stop()


def add(repository: Repository, store: RecordingStore, told: str, motor_name: str = "PUMP-A1") -> str:
    stored = store.store({"E.CFF": told.encode()})
    return repository.add_recording(stored, motor=motor_name, now_ns=time.time_ns()).recording.id


def ended(repository: Repository, *recording_ids: str) -> bool:
    waiting = (RecordingState.ANNOUNCED, RecordingState.FETCHED)
    return all(repository.recording(id_).state not in waiting for id_ in recording_ids)
