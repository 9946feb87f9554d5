"""Deletes all that a service keeps of a plant, and looks afterwards whether anything is left.

    told            what there is, before anything is touched
    alone           nobody else works on the data directory or the database
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
from service.configuration.settings import Settings
from service.process.installation import FILE as INSTALLATION
from service.process.single_instance import exclusive
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

    @property
    def database(self) -> str:
        """Return the database without its password."""
        return readable_url(self.database_url)


def purge_plan(settings: Settings, config: Path | None, *, backups: bool) -> PurgePlan:
    """Return what a purge deletes. Raises BackupError (there is no service's data), SQLAlchemyError."""
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
    return PurgePlan(
        data,
        outer,
        tuple(dict.fromkeys(one for one in folders if one.is_dir())),
        beside,
        kept,
        tuple(_left(settings, kept, backups=backups)),
        settings.database_url,
        len(found),
        sum(file.lstat().st_size for file in found),
        0 if _is_sqlite(settings.database_url) else len(PostgresqlPlace(settings.database_url).tables()),
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

    Raises BackupError (somebody uses the database, or something is left), SQLAlchemyError, OSError.
    """
    if _is_sqlite(plan.database_url):
        SqlitePlace(Path(parsed_url(plan.database_url).database or "")).require_alone()
    else:
        PostgresqlPlace(plan.database_url).remove_all()
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
    return found


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


def _left(settings: Settings, kept: Collection[Path], *, backups: bool) -> Iterator[str]:
    copies = settings.backup.directory
    if copies is not None and not backups:
        yield f"{copies}: back-ups (--backups)"
    yield from (
        f"{path}: given by people" for path in sorted(kept) if copies is None or path != copies.resolve()
    )
    yield "files of passwords, keys and certificates that the settings name"
    if settings.recordings_url is not None:
        yield f"{settings.recordings_url}: recordings in a store of its own; delete the bucket there"
    yield "back-ups and exports elsewhere, the log of the system, what gateways and channels have sent"
