"""Puts a back-up in the place of a service's data, all of it or nothing.

    every file verified                      nothing is touched before
    recordings added to the store            the old state does not know them, and loses none of its own
    database beside the old one, verified    SQLite; PostgreSQL: within one transaction
    swapped in one step                      killed before it: the old state; after it: the new one

The old SQLite file stays beside the new one, under a name of its own.
"""

import os
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from alembic.script import ScriptDirectory

from service.backup.errors import BackupError
from service.backup.layout import POOL, PRIVATE_FOLDER, locked
from service.backup.manifest import Manifest, read_manifest
from service.backup.postgresql_database import PostgresqlPlace
from service.backup.recording_copy import copy_recording, files_of
from service.backup.sqlite_database import SqlitePlace
from service.backup.verification import Verified, found_backup, verified
from service.process.single_instance import exclusive
from service.recording_store.contents import content_directory
from service.storage import migrations
from service.storage.database_url import parsed_url

SPARE_BYTES = 64 << 20
Progress = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class Place:
    """Where a back-up is put: the settings of the service that will run on it."""

    data: Path
    database_url: str
    recordings: Path


@dataclass(frozen=True, slots=True)
class Restored:
    """A back-up that was restored. added: recordings that the store did not have.

    former: the SQLite file that was there before, under its new name; None where there was none.
    """

    manifest: Manifest
    added: int
    former: Path | None


def restore_backup(
    path: Path, place: Place, *, overwrite: bool = False, progress: Progress = lambda _told: None
) -> Restored:
    """Restore the back-up at a path, or the latest one below it.

    overwrite: whether a database that is there may be replaced. Raises BackupError, AlreadyRunningError (the
    service runs), StorageError, SQLAlchemyError, OSError. The old state is as it was then.
    """
    directory, name = found_backup(path)
    place.data.mkdir(mode=PRIVATE_FOLDER, parents=True, exist_ok=True)
    with locked(directory), exclusive(place.data / "service.lock", wait=False):
        manifest = read_manifest(directory, name)
        _require_fitting(manifest, place)
        database = _database(place)
        if not overwrite:
            database.require_empty()
        _require_room(manifest, place)
        progress(f"verifying {name}")
        backup = verified(directory, name)
        backup.require_whole()
        added = _add_recordings(backup, place, progress)
        progress("restoring the database")
        former = database.restore(backup)
    return Restored(manifest, added, former)


def _require_fitting(manifest: Manifest, place: Place) -> None:
    """Raise BackupError where this version, or this kind of database, cannot take the back-up."""
    wanted = parsed_url(place.database_url).get_backend_name()
    if wanted != manifest.database:
        raise BackupError(
            f"{manifest.name}: it is of a {manifest.database} database, and database_url names {wanted}: "
            f"restore it with a database_url of {manifest.database}"
        )
    known = [one.revision for one in ScriptDirectory(str(Path(migrations.__file__).parent)).walk_revisions()]
    if manifest.revision not in known:
        raise BackupError(
            f"{manifest.name}: expected tables of revision {known[0]}, found {manifest.revision}: another "
            f"version made it ({manifest.program}); restore it with that version"
        )


def _require_room(manifest: Manifest, place: Place) -> None:
    place.recordings.mkdir(mode=PRIVATE_FOLDER, parents=True, exist_ok=True)
    free = shutil.disk_usage(place.recordings).free
    if manifest.size_bytes + SPARE_BYTES > free:
        raise BackupError(
            f"{place.recordings}: expected {manifest.size_bytes + SPARE_BYTES} free bytes, found {free}"
        )


def _add_recordings(backup: Verified, place: Place, progress: Progress) -> int:
    """Add to the store what it does not have, or not as it was; return how many recordings that is."""
    staging = place.recordings / "incoming" / "restore"
    shutil.rmtree(staging, ignore_errors=True)
    added = 0
    for number, digest in enumerate(sorted(backup.digests)):
        if number and number % 1000 == 0:
            progress(f"{number} of {len(backup.digests)} recordings")
        if _has(place.recordings, digest):
            continue
        copy_recording(backup.directory / POOL, place.recordings, staging, digest)
        added += 1
    shutil.rmtree(staging, ignore_errors=True)
    os.sync()
    return added


def _has(store: Path, digest: str) -> bool:
    """Return whether a store has a recording; one that is damaged is moved aside, to be replaced."""
    folder = content_directory(store, digest)
    if not folder.is_dir():
        return False
    try:
        files_of(store, digest)
    except BackupError:
        folder.rename(store / "incoming" / f"damaged-{digest}")
        return False
    return True


def _database(place: Place) -> SqlitePlace | PostgresqlPlace:
    parsed = parsed_url(place.database_url)
    if parsed.get_backend_name() == "sqlite":
        return SqlitePlace(Path(parsed.database or ""))
    return PostgresqlPlace(place.database_url)
