"""Recordings with samples, in the store and in the database, diagnosed as a worker does it."""

from dataclasses import replace

import numpy as np

from core.machines.parameters import Motor
from core.recordings import Digitals, Recording
from core.recordings.comtrade.writer import combined_bytes
from service.jobs.task import Diagnosed, DiagnosisTask
from service.jobs.worker import diagnose_recording
from service.recording_store.store import RecordingStore
from service.storage import Repository
from testing.machines.motors import REFERENCE
from testing.machines.phase_circuits import Fault, recording, running
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, SECOND_NS

TRIGGER_S = 0.1
BREAKER = "52A"
PICKED_UP = "50P1"
FULL_SCALE = {"A": 20.0, "V": 800.0}


def running_record(
    *,
    seconds: float = 0.6,
    sample_rate_hz: float = 4000.0,
    fault: Fault | None = None,
    begin_ns: int = NOW_NS,
) -> Recording:
    """The reference motor at half load, with a breaker that is closed and an element that picks up once."""
    bare = recording(
        running(REFERENCE, 0.5, fault=fault),
        seconds=seconds,
        sample_rate_hz=sample_rate_hz,
        noise=0.003,
    )
    count = bare.samples.shape[1]
    states = [[True, 0.2 <= k / sample_rate_hz < 0.25] for k in range(count)]
    channels = tuple(replace(one, full_scale=FULL_SCALE[one.unit]) for one in bare.channels)
    return replace(
        bare,
        channels=channels,
        start_time_ns=begin_ns,
        trigger_index=round(TRIGGER_S * sample_rate_hz),
        digitals=Digitals.of((BREAKER, PICKED_UP), np.array(states)),
    )


def add_recording(
    repository: Repository,
    store: RecordingStore,
    record: Recording,
    *,
    motor: Motor = REFERENCE,
    name: str = "PUMP-A1",
    diagnosed: bool = True,
) -> str:
    """Add a recording of a motor of the plant, and return its id. RUNNER has to be registered."""
    stored = store.store({"EVENT.CFF": combined_bytes(record, data_format="BINARY")})
    now_ns = record.first_time_ns + SECOND_NS
    added = repository.add_recording(stored, motor=name, now_ns=now_ns).recording
    if not diagnosed:
        return added.id
    claimed = repository.claim_job(now_ns=now_ns, runner=RUNNER)
    assert claimed is not None
    task = DiagnosisTask(store.source(stored.digest), motor, claimed.job.method, claimed.job.model)
    outcome = diagnose_recording(task)
    assert isinstance(outcome, Diagnosed), outcome
    repository.finish_job(
        claimed.job.id,
        outcome.findings,
        recorded_ns=outcome.recorded_ns,
        now_ns=now_ns,
        runner=RUNNER,
    )
    return added.id
