"""A back-up that the database is told of: that it began, and that it was verified or why it failed."""

import time
from pathlib import Path
from threading import Event

from sqlalchemy.exc import SQLAlchemyError

from service.backup.errors import BackupError
from service.backup.making import MadeBackup, Progress, Source, backup_directory, make_backup
from service.storage import Repository, StorageError
from service.storage.records import Actor


def make_noted_backup(
    repository: Repository,
    source: Source,
    directory: Path,
    *,
    keep: int | None = None,
    due_ns: int | None = None,
    by: Actor | None = None,
    stopping: Event | None = None,
    progress: Progress = lambda _told: None,
) -> MadeBackup | None:
    """Make a back-up and note how it ends. Return None where the one that is due is made already.

    by: who wants it, for the audit trail; None for one that the settings want.
    Raises BackupError, StorageError, SQLAlchemyError, OSError.
    """
    with backup_directory(directory, source):
        begun = repository.begin_backup(str(directory), now_ns=time.time_ns(), due_ns=due_ns)
        if begun is None:
            return None
        try:
            made = make_backup(source, directory, keep=keep, stopping=stopping, progress=progress)
        except (BackupError, StorageError, SQLAlchemyError, OSError) as error:
            repository.fail_backup(begun.id, str(error), now_ns=time.time_ns())
            raise
        repository.finish_backup(
            begun.id,
            name=made.manifest.name,
            recordings=made.manifest.recordings,
            files=made.manifest.files,
            size_bytes=made.manifest.size_bytes,
            now_ns=time.time_ns(),
            by=by,
        )
    return made
