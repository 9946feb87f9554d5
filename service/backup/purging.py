"""Deletes all that a service keeps of a plant, and looks afterwards whether anything is left.

    told            what there is, before anything is touched
    alone           nobody else works on the data directory or the database
    bucket          recordings in a store of its own, below their place, and nothing of others
    files           recordings, back-ups where they are asked for, keys, marks, all else in the data directory
    database        its file with what lies beside it; PostgreSQL: all tables, in one transaction
    looked again    what is still there is named, and is an error

Files are unlinked, not overwritten: disks and file systems keep copies that no program reaches. Whoever needs
more destroys the key of the volume (docs/how-to/purge.md). Begun again, it goes on where it was killed.
"""

import os
import shutil
from collections.abc import Collection, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

from service.backup.errors import BackupError
from service.backup.postgresql_database import PostgresqlPlace
from service.backup.sqlite_database import SqlitePlace
from service.configuration.recordings_url import BucketPlace
from service.configuration.settings import Settings
from service.process.installation import FILE as INSTALLATION
from service.process.single_instance import exclusive
from service.recording_store.bucket import objects_in
from service.recording_store.bucket_client import Bucket
from service.storage.database_url import parsed_url, readable_url

LOCK = "service.lock"
LOCKS = (LOCK, "rediagnosis.lock")
SQLITE_BESIDE = ("", "-wal", "-shm", "-journal")


@dataclass(frozen=True, slots=True)
class PurgePlan:
    """What is deleted. folders: with all that is in them. files: outside of them. tables: of PostgreSQL.

    named: the folders as people know them, also those within others.
    kept: files that people gave the service, and back-ups that nobody asked for; they stay wherever they lie.
    left: what this machine cannot delete, or was not asked to, in words.
    bucket: where recordings are in a store of its own; objects: how many of them there are.
    """

    data: Path
    folders: tuple[Path, ...]
    named: tuple[Path, ...]
    files: tuple[Path, ...]
    kept: frozenset[Path]
    left: tuple[str, ...]
    database_url: str
    number: int
    size_bytes: int
    tables: int
    bucket: BucketPlace | None
    objects: int

    @property
    def database(self) -> str:
        """Return the database without its password."""
        return readable_url(self.database_url)


def purge_plan(settings: Settings, config: Path | None, *, backups: bool) -> PurgePlan:
    """Return what a purge deletes.

    Raises BackupError (there is no service's data), SQLAlchemyError, StoreError (the bucket does not answer).
    """
    data = settings.data_directory
    _require_data(settings)
    copies = settings.backup.directory
    folders = [data]
    if settings.recordings_url is None:
        folders.append(settings.recordings_directory)
    if backups and copies is not None:
        folders.append(copies)
    outer = tuple(
        one for one in folders if one.is_dir() and not _is_in(one, [f for f in folders if f != one])
    )
    for folder in outer:
        if folder.resolve() in (Path("/"), Path.home().resolve()):
            raise BackupError(f"{folder}: it is not deleted, whatever the settings say of it")
    given = (config, settings.scd, settings.motors, None if backups else copies)
    kept = frozenset(path.resolve() for path in given if path is not None and path.exists())
    files = [settings.secrets_key_file, *_sqlite_files(settings.database_url)]
    beside = tuple(file for file in files if file.exists() and not _is_in(file, outer))
    found = [file for folder in outer for file in _files(folder, kept)] + list(beside)
    bucket = None if settings.recordings_url is None else BucketPlace.of(settings.recordings_url)
    objects = _Objects.of(bucket)
    return PurgePlan(
        data,
        outer,
        tuple(dict.fromkeys(one for one in folders if one.is_dir())),
        beside,
        kept,
        tuple(_left(settings, kept, objects, backups=backups)),
        settings.database_url,
        len(found),
        sum(file.lstat().st_size for file in found) + objects.size_bytes,
        0 if _is_sqlite(settings.database_url) else len(PostgresqlPlace(settings.database_url).tables()),
        bucket,
        objects.number,
    )


@contextmanager
def alone(plan: PurgePlan) -> Iterator[None]:
    """Keep the service and its processes from starting. Raises AlreadyRunningError where one runs."""
    with ExitStack() as held:
        for lock in (*(plan.data / name for name in LOCKS), *sorted(plan.data.glob("gateway-*.lock"))):
            held.enter_context(exclusive(lock, wait=False))
        yield


def purge(plan: PurgePlan) -> None:
    """Delete it, while nobody else is there (`alone`).

    Raises BackupError (somebody uses the database, or something is left), SQLAlchemyError, OSError (also
    StoreError).
    """
    if _is_sqlite(plan.database_url):
        SqlitePlace(Path(parsed_url(plan.database_url).database or "")).require_alone()
    else:
        PostgresqlPlace(plan.database_url).remove_all()
    if plan.bucket is not None:
        _empty_bucket(plan.bucket)
    last = {plan.data / INSTALLATION, *(plan.data / name for name in LOCKS)}  # so that it can be begun again
    for folder in plan.folders:
        _empty(folder, plan.kept, last)
    for file in (*plan.files, *sorted(last)):
        file.unlink(missing_ok=True)
    os.sync()
    still = what_is_there(plan)
    if still:
        raise BackupError(f"expected nothing to be left, found {', '.join(still[:5])}: begin again")


def what_is_there(plan: PurgePlan) -> Sequence[str]:
    """Return what there still is of what was to be deleted."""
    found = [str(file) for folder in plan.folders for file in _files(folder, plan.kept)]
    found += [str(file) for file in plan.files if file.exists()]
    if not _is_sqlite(plan.database_url):
        found += [f"table {name}" for name in PostgresqlPlace(plan.database_url).tables()]
    if plan.bucket is not None:
        found += [f"{plan.bucket}/{one.key}" for one, is_of_record in objects_in(plan.bucket) if is_of_record]
    return found


@dataclass(frozen=True, slots=True)
class _Objects:
    """What is in a bucket. others: that are none of the service's."""

    number: int = 0
    size_bytes: int = 0
    others: int = 0

    @classmethod
    def of(cls, place: BucketPlace | None) -> "_Objects":
        """Count what is below a place. Raises StoreError."""
        number = size_bytes = others = 0
        for one, is_of_record in () if place is None else objects_in(place):
            if is_of_record:
                number, size_bytes = number + 1, size_bytes + one.size_bytes
            else:
                others += 1
        return cls(number, size_bytes, others)


def _empty_bucket(place: BucketPlace) -> None:
    """Delete what the service has put there. Raises StoreError."""
    bucket = Bucket(place)
    for one, is_of_record in objects_in(place):
        if is_of_record:
            bucket.delete(one.key)


def _require_data(settings: Settings) -> None:
    data = settings.data_directory
    marks = (INSTALLATION, LOCK, "statorwatch.sqlite")
    if not any((data / mark).exists() for mark in marks):
        raise BackupError(
            f"{data}: expected the data directory of a service, found none of {', '.join(marks)}"
        )


def _empty(folder: Path, kept: Collection[Path], last: Collection[Path]) -> None:
    """Remove what is in a folder, but follow no link out of it; folders above what is kept stay."""
    for path in sorted(folder.iterdir()):
        if path in last or path.resolve() in kept:
            continue
        if path.is_symlink() or not path.is_dir():
            path.unlink()
        elif any(_is_in(one, [path.resolve()]) for one in kept):
            _empty(path, kept, last)
        else:
            shutil.rmtree(path)


def _files(folder: Path, kept: Collection[Path]) -> Iterator[Path]:
    for root, folders, names in os.walk(folder):
        inside = Path(root)
        folders[:] = [name for name in folders if (inside / name).resolve() not in kept]
        yield from (inside / name for name in folders if (inside / name).is_symlink())
        yield from (inside / name for name in names if (inside / name).resolve() not in kept)


def _is_in(path: Path, folders: Collection[Path]) -> bool:
    return any(path.resolve().is_relative_to(folder.resolve()) for folder in folders)


def _is_sqlite(url: str) -> bool:
    return parsed_url(url).get_backend_name() == "sqlite"


def _sqlite_files(url: str) -> list[Path]:
    if not _is_sqlite(url):
        return []
    file = Path(parsed_url(url).database or "")
    return [file.with_name(f"{file.name}{ending}") for ending in SQLITE_BESIDE]


def _left(settings: Settings, kept: Collection[Path], objects: _Objects, *, backups: bool) -> Iterator[str]:
    copies = settings.backup.directory
    if copies is not None and not backups:
        yield f"{copies}: back-ups (--backups)"
    yield from (
        f"{path}: given by people" for path in sorted(kept) if copies is None or path != copies.resolve()
    )
    yield "files of passwords, keys and certificates that the settings name"
    if settings.recordings_url is not None:
        yield f"{settings.recordings_url}: {objects.others} objects that are no recordings of the service"
        yield "old versions of objects, where the store keeps them"
    yield "back-ups and exports elsewhere, the log of the system, what gateways and channels have sent"
