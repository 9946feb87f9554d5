"""How long a back-up, its verification and restoring it take, by the number of recordings.

    python -m benchmarks.storage.backups [--recordings 1000 10000] [--bytes 100000] [--postgresql]

Each recording has a file of random bytes and a diagnosis as long as that of a real one. A second back-up
finds one per cent of new ones. The files lie in the temporary folder, or below --directory.
"""

import argparse
import json
import shutil
import tempfile
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from random import Random

from benchmarks.reporting import table
from benchmarks.storage.documents import document
from core.diagnosis.verdict import Verdict
from service.backup.making import Source
from service.backup.noted import make_noted_backup
from service.backup.restoring import Place, restore_backup
from service.backup.verification import verify_backup
from service.configuration.settings import sqlite_url
from service.recording_store.contents import StoredFile, content_directory, manifest_digest
from service.storage import Repository, connect, migrate
from service.storage.models import DiagnosisRow, JobRow, RecordingFileRow, RecordingRow
from service.storage.states import JobState, RecordingSource, RecordingState
from testing.service.plants import NOW_NS, SECOND_NS, two_motor_plant
from testing.service.postgresql import PostgresServer, binaries, serving_postgresql

NEW_SHARE = 100
"""One recording of so many is new in the second back-up."""


@dataclass(frozen=True)
class Times:
    """What each step took [s], and how large the back-up is [bytes]."""

    first_s: float
    again_s: float
    verify_s: float
    restore_s: float
    size_bytes: int


class FillingRepository(Repository):
    """Takes many recordings in one transaction."""

    def fill(self, store: Path, numbers: range, size_bytes: int) -> None:
        """Write recordings of these numbers into the store and the database, each with a diagnosis."""
        with self._write() as session:
            for number in numbers:
                files = write_record(store, number, size_bytes)
                id_ = str(uuid.UUID(int=number + 1))
                at_ns = NOW_NS + number * SECOND_NS
                row = recording_row(id_, number, files, at_ns)
                session.add(row)
                session.flush()
                session.add(job_row(id_, at_ns))
                session.add_all(RecordingFileRow(recording_id=id_, **vars_of(file)) for file in files)
                session.flush()
                session.add(diagnosis_row(id_, at_ns))


def write_record(store: Path, number: int, size_bytes: int) -> tuple[StoredFile, ...]:
    """Write the files of a record into the folder of their content."""
    contents = {
        f"HR_{number:05}.CFG": f"HR_{number:05},of a benchmark\n".encode() * 50,
        f"HR_{number:05}.DAT": Random(number).randbytes(size_bytes),  # noqa: S311 - no secret
    }
    files = tuple(
        StoredFile(name, len(content), sha256(content).hexdigest()) for name, content in contents.items()
    )
    folder = content_directory(store, manifest_digest(files))
    folder.mkdir(parents=True)
    for name, content in contents.items():
        (folder / name).write_bytes(content)
    return files


def vars_of(file: StoredFile) -> dict[str, object]:
    """Return the columns of a file."""
    return {"name": file.name, "size_bytes": file.size_bytes, "sha256": file.sha256}


def recording_row(id_: str, number: int, files: tuple[StoredFile, ...], at_ns: int) -> RecordingRow:
    """Return the row of a recording that is diagnosed."""
    return RecordingRow(
        id=id_,
        motor="PUMP-A1",
        source=RecordingSource.UPLOAD,
        name=f"HR_{number:05}",
        digest=manifest_digest(files),
        size_bytes=sum(file.size_bytes for file in files),
        state=RecordingState.DIAGNOSED,
        attempts=0,
        announced_ns=at_ns,
        fetched_ns=at_ns,
        recorded_ns=at_ns,
    )


def job_row(id_: str, at_ns: int) -> JobRow:
    """Return the row of a job that is done."""
    return JobRow(
        id=id_,
        recording_id=id_,
        motor="PUMP-A1",
        method="hcpa",
        model="split-winding",
        state=JobState.DONE,
        attempts=1,
        not_before_ns=at_ns,
        created_ns=at_ns,
        finished_ns=at_ns,
    )


def diagnosis_row(id_: str, at_ns: int) -> DiagnosisRow:
    """Return the row of a diagnosis."""
    return DiagnosisRow(
        id=id_,
        job_id=id_,
        recording_id=id_,
        motor="PUMP-A1",
        current=True,
        created_ns=at_ns,
        recorded_ns=at_ns,
        verdict=Verdict.HEALTHY,
        method="hcpa",
        model="split-winding",
        document=DOCUMENT,
    )


DOCUMENT = json.loads(document(0.0))


def seconds(work: Callable[[], object]) -> float:
    """Return how long the work takes [s]."""
    began_s = time.monotonic()
    work()
    return time.monotonic() - began_s


def measured(url: str, elsewhere: str, root: Path, recordings: int, size_bytes: int) -> Times:
    """Fill a database, back it up twice, verify the back-up and restore it elsewhere."""
    migrate(url)
    engine = connect(url)
    repository = FillingRepository(engine)
    repository.sync_plant(two_motor_plant())
    store = root / "recordings"
    repository.fill(store, range(recordings), size_bytes)
    source, directory = Source(url, store, {}), root / "copies"
    first_s = seconds(lambda: make_noted_backup(repository, source, directory))
    repository.fill(store, range(recordings, recordings + recordings // NEW_SHARE), size_bytes)
    again_s = seconds(lambda: make_noted_backup(repository, source, directory))
    engine.dispose()
    verify_s = seconds(lambda: verify_backup(directory).require_whole())
    place = Place(root / "elsewhere", elsewhere, root / "elsewhere" / "recordings")
    restore_s = seconds(lambda: restore_backup(directory, place))
    return Times(first_s, again_s, verify_s, restore_s, verify_backup(directory).manifest.size_bytes)


@contextmanager
def databases(server: PostgresServer | None, root: Path) -> Iterator[tuple[str, str]]:
    """Provide a database, and an empty place for another one."""
    if server is None:
        yield sqlite_url(root), sqlite_url(root / "elsewhere")
        return
    with server.database() as url, server.database(migrated=False) as elsewhere:
        yield url, elsewhere


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--recordings", type=int, nargs="+", default=[1_000, 10_000])
    parser.add_argument("--bytes", type=int, default=100_000, help="of the samples of each recording")
    parser.add_argument("--directory", type=Path, help="where the files are made (default: /tmp or TMPDIR)")
    parser.add_argument("--postgresql", action="store_true")
    given = parser.parse_args()
    rows = []
    with ExitStack() as opened:
        server = None
        if given.postgresql:
            folder = binaries()
            if folder is None:
                parser.error("--postgresql: no server is installed")
            server = opened.enter_context(serving_postgresql(folder))
        for number in given.recordings:
            root = Path(tempfile.mkdtemp(dir=given.directory))
            opened.callback(shutil.rmtree, root)
            with databases(server, root) as (url, elsewhere):
                times = measured(url, elsewhere, root, number, given.bytes)
            rows.append(
                (
                    f"{number:,}",
                    f"{times.size_bytes / 1e6:,.0f}",
                    *(
                        f"{one:.1f}"
                        for one in (times.first_s, times.again_s, times.verify_s, times.restore_s)
                    ),
                )
            )
    print("\n".join(table(("Recordings", "MB", "First [s]", "Again [s]", "Verify [s]", "Restore [s]"), rows)))


if __name__ == "__main__":
    main()
