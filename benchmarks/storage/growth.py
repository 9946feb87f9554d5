"""How much a motor adds to the database and to the recording store in a year, from measured rows and records.

    python -m benchmarks.storage.growth [--records-a-day 4] [--record-bytes BYTES]

It writes rows into an SQLite database as the service does, and asks SQLite how large each table is, with its
indexes. A record is examples/RUNNING, and its diagnosis that of the service, or as large as --record-bytes.
"""

import argparse
import sqlite3
import tempfile
from collections import Counter
from contextlib import closing
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

from benchmarks.storage.forgetting import MOTORS, plant
from benchmarks.storage.forgetting import fill as fill_measurements
from core.findings.examining import examine
from core.findings.findings import Findings
from core.machines.motor_file.reader import read_motor
from core.recordings import read
from service.condition.worker import fold_due
from service.configuration.settings import sqlite_url
from service.plant import AveragingStep
from service.recording_store.contents import StoredFile
from service.recording_store.recording import StoredRecording
from service.storage import Repository, connect, migrate
from service.storage.records import RemoteRecord
from testing.memory_folder import memory_folder
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER, register_runner
from testing.service.plants import NOW_NS, SECOND_NS

EXAMPLES = Path(__file__).parents[2] / "examples"
RECORDS = 2_000
DELETED = 500
MEASUREMENTS = 200_000
BLOCK_BYTES = 4096
DAYS = 365
A_DAY_S = 86_400
SAMPLE_PERIOD_S, SAMPLE_DAYS, MINUTE_DAYS = 10, 1, 31
"""The defaults of the settings metering_period_s, metering_sample_days and metering_minute_days."""

OF_A_RECORD = (
    "recordings",
    "recording_files",
    "remote_records",
    "recording_requests",
    "jobs",
    "diagnoses",
    "observations",
)


def stored(number: int, directory: Path) -> StoredRecording:
    """A record as the store describes it; its folder is the same for all, for only rows are measured."""
    files = tuple(
        StoredFile(f"HR_{number:05}{suffix}", 50_000, sha256(f"{number}{suffix}".encode()).hexdigest())
        for suffix in (".CFG", ".DAT")
    )
    return StoredRecording(sha256(str(number).encode()).hexdigest(), files, directory.is_dir)


def write_records(repository: Repository, directory: Path, examined: Findings) -> None:
    """Request, pull, diagnose and fold RECORDS records; delete some of as many others."""
    register_runner(repository)
    assert examined.observation is not None
    motors = plant().motors
    for number in range(RECORDS + DELETED):
        motor = motors[number % MOTORS]
        now_ns = NOW_NS + number * SECOND_NS
        request = repository.request_recording(motor.name, now_ns=now_ns)
        repository.mark_triggered(request.id, now_ns=now_ns)
        added = repository.add_recording(
            stored(number, directory),
            motor=motor.name,
            relay=motor.relay,
            remote=RemoteRecord(f"HR_{number:05}", 50_439, now_ns),
            recording_request_id=request.id,
            now_ns=now_ns,
        )
        claimed = repository.claim_job(now_ns=2**62, runner=RUNNER)
        assert claimed is not None
        repository.finish_job(
            claimed.job.id,
            findings_of(examined.diagnosis, observation=replace(examined.observation, time_ns=now_ns)),
            recorded_ns=now_ns,
            now_ns=now_ns,
            runner=RUNNER,
        )
        if number >= RECORDS:
            repository.delete_recording(added.recording.id, "a recording of another motor", now_ns=now_ns)
    of = {motor.name: motor.motor for motor in motors}
    while waiting := repository.motors_to_fold():
        for name in waiting:
            fold_due(repository, of[name])


def row_bytes(file: Path) -> dict[str, float]:
    """The size of each table with its indexes, divided by its rows [bytes]."""
    with closing(sqlite3.connect(file)) as connection:
        sizes: Counter[str] = Counter()
        owners = dict(connection.execute("SELECT name, tbl_name FROM sqlite_master"))
        for name, size in connection.execute("SELECT name, sum(pgsize) FROM dbstat GROUP BY name"):
            sizes[owners.get(name, name)] += size
        tables = (*OF_A_RECORD, "deletions", "deleted_remote_records", "measurements")
        rows = {name: connection.execute(f"SELECT count(*) FROM {name}").fetchone()[0] for name in tables}  # noqa: S608 - own names
    return {name: sizes[name] / rows[name] for name in tables}


def measured_rows(examined: Findings) -> dict[str, float]:
    with tempfile.TemporaryDirectory(prefix="growth-", dir=memory_folder()) as name:
        directory = Path(name)
        url = sqlite_url(directory)
        migrate(url)
        engine = connect(url)
        repository = Repository(engine)
        repository.sync_plant(plant())
        write_records(repository, directory, examined)
        fill_measurements(engine, MEASUREMENTS)
        with engine.connect() as connection:
            connection.exec_driver_sql("PRAGMA wal_checkpoint(TRUNCATE)")
        engine.dispose()
        return row_bytes(Path(str(engine.url.database)))


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--records-a-day", type=float, default=4)
    parser.add_argument("--record-bytes", type=int)
    options = parser.parse_args()
    files = [EXAMPLES / f"RUNNING{suffix}" for suffix in (".CFG", ".DAT")]
    sizes = (
        [file.stat().st_size for file in files] if options.record_bytes is None else [options.record_bytes]
    )
    on_disk = sum(-(-size // BLOCK_BYTES) for size in sizes) * BLOCK_BYTES + BLOCK_BYTES
    found = measured_rows(examine(read(files[0]), read_motor(EXAMPLES / "motor.toml")))
    print("| table | bytes a row |\n|---|---|")
    for name, size in found.items():
        print(f"| `{name}` | {size:,.0f} |")
    records = options.records_a_day * DAYS
    of_a_record = sum(found[name] for name in OF_A_RECORD) + found["recording_files"]
    a_value = found["measurements"]
    lasting = SAMPLE_DAYS * A_DAY_S / SAMPLE_PERIOD_S + MINUTE_DAYS * A_DAY_S / AveragingStep.MINUTE.value
    quarters = DAYS * A_DAY_S / AveragingStep.QUARTER_HOUR.value
    deletion = found["deletions"] + found["deleted_remote_records"]
    print(f"\n| a motor with {options.records_a_day:g} records a day | rows or records | MB |\n|---|---|---|")
    for what, number, size in (
        ("files of the recordings, a year", records, on_disk),
        ("rows of the recordings, a year", records, of_a_record),
        ("means of a quarter of an hour, a year", quarters, a_value),
        ("samples and means of a minute, once", lasting, a_value),
        ("list of deletions, a year, where as many are deleted as come", records, deletion),
    ):
        print(f"| {what} | {number:,.0f} | {number * size / 1e6:.1f} |")


if __name__ == "__main__":
    main()
