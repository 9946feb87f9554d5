"""Removes the oldest back-ups, and the recordings that no back-up lists any more."""

import shutil
from pathlib import Path

from service.backup.layout import POOL, backups_in
from service.backup.manifest import read_sums
from service.recording_store.contents import is_digest


def prune(directory: Path, keep: int) -> tuple[str, ...]:
    """Remove the oldest back-ups beyond so many; return their names.

    Recordings go only where the list of every back-up that stays can be read. Raises BackupError, OSError.
    """
    names = backups_in(directory)
    removed = tuple(names[:-keep])
    for name in removed:
        shutil.rmtree(directory / name)
    needed = {file.digest for name in names[-keep:] for file in read_sums(directory, name)}
    for folder in sorted((directory / POOL).glob("??/*")):
        if is_digest(folder.name) and folder.name not in needed:
            shutil.rmtree(folder)
    return removed
