"""Makes a back-up: the database first, then the recordings that it names, then every file is read again.

A recording that is deleted meanwhile is missing in the store, and a newer copy of the database does not name
it. So the database is copied again until the store has what the copy names.

    incomplete-<name>/ made         killed here: the next back-up removes it
    renamed to <name>/              one step; from then on it counts
    those beyond `keep` removed     killed here: the next back-up goes on
"""

import os
import shutil
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from threading import Event

from service.backup.database_copy import DatabaseCopy
from service.backup.errors import BackupError, BackupStoppedError
from service.backup.layout import (
    CONFIGURATION,
    DATABASE_FILE,
    DATABASE_FOLDER,
    INCOMPLETE,
    POOL,
    PRIVATE_FOLDER,
    ListedFile,
    backups_in,
    create,
    hash_of,
    locked,
    prepare,
)
from service.backup.manifest import FORMAT, Lost, Manifest, write_manifest, write_sums
from service.backup.postgresql_database import copy_postgresql
from service.backup.pruning import prune
from service.backup.recording_copy import copy_recording, files_of
from service.backup.sqlite_database import copy_sqlite
from service.recording_store.contents import StoredFile, content_directory
from service.storage.database_url import parsed_url

MOST_COPIES = 5
"""Of the database, while recordings are deleted."""

Progress = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class Source:
    """What is backed up: database, recordings, and the files of the plant by their names in the back-up."""

    database_url: str
    recordings: Path
    configuration: Mapping[str, Path]


@dataclass(frozen=True, slots=True)
class MadeBackup:
    """A back-up that was made. copied: how many recordings no earlier back-up had.  removed: of others."""

    directory: Path
    manifest: Manifest
    copied: int
    removed: tuple[str, ...]


def make_backup(
    source: Source,
    directory: Path,
    *,
    keep: int | None = None,
    stopping: Event | None = None,
    progress: Progress = lambda _told: None,
) -> MadeBackup:
    """Back up into a directory of back-ups, and read every file of the back-up again.

    The caller has prepared the directory and holds its lock.

    keep: remove the oldest back-ups beyond so many; None keeps all.  stopping: set when that should end.
    Raises BackupError, BackupStoppedError, StorageError, SQLAlchemyError, OSError.
    """
    return _Making(source, directory, stopping or Event(), progress).make(keep)


@contextmanager
def backup_directory(directory: Path, source: Source) -> Iterator[None]:
    """Prepare a directory for back-ups of a source, and hold its lock. Raises BackupError, OSError."""
    inside, outside = directory.resolve(), source.recordings.resolve()
    if inside == outside or outside in inside.parents:
        raise BackupError(f"{directory}: expected a directory outside of the recordings, {outside}")
    prepare(directory)
    with locked(directory):
        yield


class _Making:
    def __init__(self, source: Source, directory: Path, stopping: Event, progress: Progress) -> None:
        self._source = source
        self._directory = directory
        self._pool = directory / POOL
        self._staging = directory / f"{INCOMPLETE}pool"
        self._stopping = stopping
        self._progress = progress
        self._known: dict[str, tuple[StoredFile, ...]] = {}
        self._copied: set[str] = set()

    def make(self, keep: int | None) -> MadeBackup:
        for left in self._directory.glob(f"{INCOMPLETE}*"):
            shutil.rmtree(left)
        name = self._new_name()
        folder = self._directory / f"{INCOMPLETE}{name}"
        folder.mkdir(mode=PRIVATE_FOLDER)
        copy, lost = self._copy(folder)
        configuration = self._copy_configuration(folder)
        shutil.rmtree(self._staging, ignore_errors=True)
        os.sync()  # before all of it is read again, and before it counts
        files = [
            *self._own_files(folder, name, (*copy.files, *configuration)),
            *self._recording_files(copy.digests - lost.keys()),
        ]
        manifest = Manifest(
            format=FORMAT,
            name=name,
            made=datetime.now(UTC).isoformat(timespec="seconds").replace("+00:00", "Z"),
            program=f"statorwatch {version('statorwatch')}",
            database=copy.kind,
            revision=copy.revision,
            recordings=len(copy.digests) - len(lost),
            files=len(files),
            size_bytes=sum(size_bytes for _, size_bytes in files),
            sums=write_sums(folder, (file for file, _ in files)),
            tables=copy.tables,
            lost=[Lost(digest=digest, problem=problem[:1000]) for digest, problem in sorted(lost.items())],
        )
        write_manifest(folder, manifest)
        os.sync()
        folder.rename(self._directory / name)
        removed = () if keep is None else prune(self._directory, keep)
        os.sync()
        return MadeBackup(self._directory, manifest, len(self._copied), removed)

    def _new_name(self) -> str:
        """Return the name of the time, or of the second after the latest one."""
        now_s = datetime.now(UTC).timestamp()
        taken = set(backups_in(self._directory))
        while True:
            name = f"backup-{datetime.fromtimestamp(now_s, UTC):%Y%m%dT%H%M%SZ}"
            if name not in taken:
                return name
            now_s += 1

    def _copy(self, folder: Path) -> tuple[DatabaseCopy, dict[str, str]]:
        """Copy the database and what it names; return also what was lost already, and how."""
        before: frozenset[str] = frozenset()
        for _ in range(MOST_COPIES):
            self._progress("copying the database")
            copy = self._copy_database(folder)
            lost = self._copy_recordings(copy.digests)
            if not lost or lost.keys() <= before:
                return copy, lost
            before = frozenset(lost)
        return copy, lost

    def _copy_database(self, folder: Path) -> DatabaseCopy:
        (folder / DATABASE_FILE).unlink(missing_ok=True)
        shutil.rmtree(folder / DATABASE_FOLDER, ignore_errors=True)
        parsed = parsed_url(self._source.database_url)
        if parsed.get_backend_name() == "sqlite":
            return copy_sqlite(Path(parsed.database or ""), folder)
        return copy_postgresql(self._source.database_url, folder / DATABASE_FOLDER)

    def _copy_recordings(self, digests: frozenset[str]) -> dict[str, str]:
        lost = {}
        for number, digest in enumerate(sorted(digests - self._known.keys())):
            self._require_going_on()
            if number % 1000 == 0 and number:
                self._progress(f"{number} of {len(digests)} recordings")
            try:
                self._known[digest] = self._in_pool(digest)
            except BackupError as error:
                lost[digest] = str(error)
        return lost

    def _in_pool(self, digest: str) -> tuple[StoredFile, ...]:
        """Return the files of a recording in the pool; copied unless they are there, and whole."""
        place = content_directory(self._pool, digest)
        if place.is_dir():
            try:
                return files_of(self._pool, digest)
            except BackupError as error:
                self._progress(f"copied again, for it was damaged: {error}")
                shutil.rmtree(place)
        files = copy_recording(self._source.recordings, self._pool, self._staging, digest)
        self._copied.add(digest)
        return files

    def _copy_configuration(self, folder: Path) -> list[str]:
        names = []
        if self._source.configuration:
            (folder / CONFIGURATION).mkdir(mode=PRIVATE_FOLDER)
        for name, path in self._source.configuration.items():
            with create(folder / CONFIGURATION / name) as target:
                target.write(path.read_bytes())
            names.append(f"{CONFIGURATION}/{name}")
        return names

    def _own_files(self, folder: Path, name: str, paths: tuple[str, ...]) -> Iterator[tuple[ListedFile, int]]:
        for path in paths:
            self._require_going_on()
            digest, size_bytes = hash_of(folder, path)
            yield ListedFile(f"{name}/{path}", digest), size_bytes

    def _recording_files(self, digests: frozenset[str]) -> Iterator[tuple[ListedFile, int]]:
        """Yield the files of all recordings; those that were just copied are read again."""
        for digest in sorted(digests):
            self._require_going_on()
            files = files_of(self._pool, digest) if digest in self._copied else self._known[digest]
            for file in files:
                path = f"{POOL}/{digest[:2]}/{digest}/{file.name}"
                yield ListedFile(path, file.sha256), file.size_bytes

    def _require_going_on(self) -> None:
        if self._stopping.is_set():
            raise BackupStoppedError(f"{self._directory}: the back-up was stopped before it was complete")
