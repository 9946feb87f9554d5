"""A plant with recordings that were diagnosed before, and no service that runs."""

import json
import time
from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import Engine

from core.recordings.comtrade.writer import combined_bytes
from service.condition.motor_data import document_of
from service.configuration.settings import Settings
from service.demo import MOTORS
from service.plant import Plant, read_plant
from service.recording_store.opening import open_store
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect
from testing.machines.phase_circuits import Fault
from testing.service.database import make_database
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, SECOND_NS, healthy
from testing.service.processes import switched_off_plant
from testing.service.real_recordings import running_record

MOTOR = "PUMP-A1"
KINDS = 6
"""So many levels of the fault; the first is none."""


@dataclass(frozen=True)
class Archive:
    """The recordings' ids, and what is needed to work with them. Its diagnoses are by a test, all healthy."""

    config: Path
    settings: Settings
    plant: Plant
    engine: Engine
    recordings: tuple[str, ...]

    @property
    def repository(self) -> Repository:
        return Repository(self.engine)

    @property
    def store(self) -> RecordingStore:
        return open_store(self.settings)

    def documents(self) -> list[str]:
        """What is stored of each recording as JSON, but for the time that its computation took."""
        found = [self.repository.current_diagnosis(one) for one in self.recordings]
        documents = [{**one.document, "compute_seconds": 0.0} for one in found if one is not None]
        return [json.dumps(one, sort_keys=True) for one in documents]

    def made(self) -> list[int]:
        """How many diagnoses of each recording are done, without the first."""
        jobs = [self.repository.jobs(one, limit=20).items for one in self.recordings]
        return [sum(one.diagnosis is not None for one in of) - 1 for of in jobs]


def make_archive(directory: Path, records: int, recordings_url: str | None = None) -> Archive:
    """Store records of one motor, most with shorted turns, and diagnose all as healthy.

    recordings_url: of a bucket that has them; None for the folder of the data directory.
    """
    config = directory / "mcc.toml"
    data = directory / "data"
    data.mkdir()
    config.write_text(
        f'data_directory = "data"\nscd = "{switched_off_plant(directory).name}"\nmotors = "{MOTORS}"\n'
    )
    if recordings_url is not None:
        config.write_text(config.read_text() + f'recordings_url = "{recordings_url}"\n')
    settings = Settings.load(config)
    engine = connect(make_database(data))
    repository = Repository(engine)
    plant = read_plant(settings)
    repository.sync_plant(plant)
    repository.note_motors({one.name: document_of(one.motor) for one in plant.motors}, now_ns=NOW_NS)
    repository.register_runner(RUNNER, installation="tests", now_ns=NOW_NS, max_attempts=3)
    store = open_store(settings)
    ids = []
    for k in range(records):
        begin_ns = NOW_NS + k * SECOND_NS
        fault = Fault(0.005 * (k % KINDS), 1) if k % KINDS else None
        record = running_record(begin_ns=begin_ns, fault=fault)
        stored = store.store({"EVENT.CFF": combined_bytes(record, data_format="BINARY")})
        ids.append(repository.add_recording(stored, motor=MOTOR, now_ns=begin_ns).recording.id)
        claimed = repository.claim_job(now_ns=time.time_ns(), runner=RUNNER)
        assert claimed is not None
        repository.finish_job(
            claimed.job.id,
            findings_of(healthy()),
            recorded_ns=begin_ns,
            now_ns=begin_ns + SECOND_NS,
            runner=RUNNER,
        )
    return Archive(config, settings, plant, engine, tuple(ids))
