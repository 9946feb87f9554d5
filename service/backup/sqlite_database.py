"""An SQLite database in back-ups: copied by SQLite's online back-up interface, and put in place again."""

import os
import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from datetime import UTC, datetime
from pathlib import Path

from service.backup.database_copy import DatabaseCopy
from service.backup.errors import BackupError
from service.backup.layout import CHUNK_BYTES, DATABASE_FILE, PRIVATE_FILE, PRIVATE_FOLDER, create, opened
from service.backup.manifest import Manifest
from service.backup.sqlite_reading import digests_of, sqlite_opened
from service.backup.verification import Verified
from service.storage import migrate


def copy_sqlite(source: Path, folder: Path) -> DatabaseCopy:
    """Copy a database into the folder of a back-up while others write to it. Raises BackupError."""
    target = folder / DATABASE_FILE
    create(target).close()
    try:
        with closing(sqlite3.connect(source)) as live, closing(sqlite3.connect(target)) as copy:
            live.execute("PRAGMA busy_timeout = 30000")
            live.backup(copy)
            # All of it is in the one file then, and to read it makes no other.
            copy.execute("PRAGMA journal_mode = DELETE")
    except sqlite3.Error as error:
        raise BackupError(f"{source}: the database cannot be copied: {error}") from error
    with sqlite_opened(target) as copy:
        (revision,) = copy.execute("SELECT version_num FROM alembic_version").fetchone()
        return DatabaseCopy("sqlite", revision, (DATABASE_FILE,), digests_of(copy))


class SqlitePlace:
    """The place of an SQLite file, where one may be already."""

    def __init__(self, file: Path) -> None:
        self._file = file

    def require_empty(self) -> None:
        """Raise BackupError where there is a database."""
        if self._file.exists():
            raise BackupError(
                f"{self._file}: a database is there already; with --overwrite it is replaced, and kept under "
                "another name"
            )

    def require_alone(self) -> None:
        """Raise BackupError where another program has the database open."""
        if self._file.exists():
            with _sqlite_alone(self._file):
                pass

    def restore(self, backup: Verified) -> Path | None:
        """Put the back-up's database in place in one step. Return where the one before is now, if any.

        Raises BackupError, OSError.
        """
        self._file.parent.mkdir(mode=PRIVATE_FOLDER, parents=True, exist_ok=True)
        arriving = self._file.with_name(f"{self._file.name}.restoring")
        arriving.unlink(missing_ok=True)
        try:
            self._copy(backup, arriving)
            self._require_ours(arriving, backup.manifest)
            os.sync()
            former = self._set_aside()
            arriving.replace(self._file)
            _sync_folder(self._file.parent)
        finally:
            arriving.unlink(missing_ok=True)
        return former

    def _copy(self, backup: Verified, arriving: Path) -> None:
        path = f"{backup.manifest.name}/{DATABASE_FILE}"
        with opened(backup.directory, path) as source, create(arriving) as target:
            shutil.copyfileobj(source, target, CHUNK_BYTES)

    def _require_ours(self, arriving: Path, manifest: Manifest) -> None:
        """Raise BackupError unless the copy is sound, and has the tables and triggers that it should have.

        A trigger of somebody else's would run whenever the service writes.
        """
        expected = self._file.with_name(f"{self._file.name}.expected")
        expected.unlink(missing_ok=True)
        try:
            create(expected).close()
            migrate(f"sqlite:///{expected}", revision=manifest.revision)
            with sqlite_opened(arriving) as copy, sqlite_opened(expected) as fresh:
                check = copy.execute("PRAGMA integrity_check(1)").fetchone()
                if check != ("ok",):
                    raise BackupError(f"{backup_name(manifest)}: expected a sound database, found {check}")
                found, wanted = _schema(copy), _schema(fresh)
        finally:
            for path in expected.parent.glob(f"{expected.name}*"):
                path.unlink()
        if found != wanted:
            odd = sorted(found.symmetric_difference(wanted))[0]
            raise BackupError(
                f"{backup_name(manifest)}: expected the tables and triggers of revision {manifest.revision}, "
                f"found a difference: {odd[0]} {odd[1]}"
            )

    def _set_aside(self) -> Path | None:
        """Give the old database a second name, with all that was written to it. Raises BackupError."""
        if not self._file.exists():
            return None
        with _sqlite_alone(self._file):
            former = self._file.with_name(f"{self._file.name}.before-{datetime.now(UTC):%Y%m%dT%H%M%SZ}")
            former.unlink(missing_ok=True)
            os.link(self._file, former)
            former.chmod(PRIVATE_FILE)
        return former


def backup_name(manifest: Manifest) -> str:
    """Return how a message calls a back-up."""
    return f"{manifest.name}/{DATABASE_FILE}"


@contextmanager
def _sqlite_alone(file: Path) -> Iterator[None]:
    """Have all of a database in its one file. Raises BackupError where another program has it open.

    What a damaged database still has beside its file is moved aside with it.
    """
    try:
        with closing(sqlite3.connect(file, timeout=1.0)) as old:
            old.execute("PRAGMA journal_mode = DELETE").fetchone()
    except sqlite3.OperationalError as error:
        raise BackupError(f"{file}: another program uses this database: {error}") from error
    except sqlite3.DatabaseError:
        stamp = f"{datetime.now(UTC):%Y%m%dT%H%M%SZ}"
        for suffix in ("-wal", "-shm"):
            beside = file.with_name(file.name + suffix)
            if beside.exists():
                beside.rename(file.with_name(f"{file.name}.before-{stamp}{suffix}"))
    yield


def _schema(database: sqlite3.Connection) -> set[tuple[str, str, str]]:
    """Return what a database consists of; of triggers and views also what they do."""
    rows = database.execute(
        "SELECT type, name, CASE WHEN type IN ('trigger', 'view') THEN sql ELSE tbl_name END "
        "FROM sqlite_master WHERE name NOT LIKE 'sqlite\\_%' ESCAPE '\\'"
    )
    return {(str(kind), str(name), str(told)) for kind, name, told in rows}


def _sync_folder(folder: Path) -> None:
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
