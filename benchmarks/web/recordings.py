"""A recording of 60,000 samples in six channels, in the store and the database of a filled plant."""

import time
from pathlib import Path

import numpy as np

from benchmarks.storage.plant import motor_name
from core.recordings import Channel, Quantity, Recording, comtrade
from service.configuration.settings import sqlite_url
from service.recording_store.folder import FolderStore
from service.storage import Repository, connect
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER, register_runner
from testing.service.plants import fault

SAMPLES, SAMPLE_RATE_HZ, FREQUENCY_HZ = 60_000, 10_000.0, 50.0
FULL_SCALE = 100.0, 1000.0


def long_recording(start_ns: int) -> Recording:
    """Return sines with noise, six seconds of them."""
    times_s = np.arange(SAMPLES) / SAMPLE_RATE_HZ
    angles = 2 * np.pi * FREQUENCY_HZ * times_s - np.array([0, 2, 4])[:, None] * np.pi / 3
    noise = np.random.default_rng(1).normal(scale=0.01, size=(6, SAMPLES))
    samples = np.vstack([20 * np.sin(angles - 0.6), 325 * np.sin(angles)]) * (1 + noise)
    channels = (
        *(Channel(f"I{x.upper()}", Quantity.CURRENT, x, "A", FULL_SCALE[0]) for x in "abc"),
        *(Channel(f"V{x.upper()}", Quantity.PHASE_VOLTAGE, x, "V", FULL_SCALE[1]) for x in "abc"),
    )
    return Recording(
        samples, SAMPLE_RATE_HZ, start_ns, channels, trigger_index=1000, nominal_frequency_hz=FREQUENCY_HZ
    )


def store_long_recording(data: Path) -> str:
    """Put the recording into a data directory, as one of MOTOR-0003 that is diagnosed; return its id."""
    folder = data / "long"
    folder.mkdir()
    now_ns = time.time_ns()
    comtrade.write(folder / "LONG.CFG", long_recording(now_ns))
    files = {path.name: path.read_bytes() for path in folder.iterdir()}
    engine = connect(sqlite_url(data))
    try:
        repository = Repository(engine)
        register_runner(repository)
        stored = FolderStore(data / "recordings").store(files)
        added = repository.add_recording(stored, motor=motor_name(3), now_ns=now_ns)
        claimed = repository.claim_job(now_ns=now_ns, runner=RUNNER)
        assert claimed is not None
        repository.finish_job(
            claimed.job.id, findings_of(fault()), recorded_ns=now_ns, now_ns=now_ns, runner=RUNNER
        )
        return added.recording.id
    finally:
        engine.dispose()
