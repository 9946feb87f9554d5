"""Finds folders of the recording store that the database does not know, and deletes them after a while.

A service that is killed after it has stored a record's files, and before it has written the row, leaves such
a folder. So does whoever copies one there. A record that arrives is left alone for an hour. Whoever adds its
row holds the folder's lock (repository/recordings/folders.py) and looks whether the folder is there; whoever
moves the folder holds the same lock. So no recording loses its files, whatever the clocks say.
"""

from dataclasses import dataclass

import structlog

from core.units import SECONDS_PER_DAY
from service.recording_store.unknown_folders import PREFIXES, Folder, UnknownFolders
from service.storage import Repository

log = structlog.get_logger(__name__)

SETTLED_S = 3600.0
"""A folder that is younger may belong to a record that is being added."""

KEPT_DAYS = 30.0
"""So long a folder lies apart before it is deleted."""


@dataclass(frozen=True, slots=True)
class Ages:
    """How old a folder must be before it is moved apart [s], and how long it lies there then [days]."""

    settled_s: float = SETTLED_S
    kept_days: float = KEPT_DAYS


AGES = Ages()


class UnknownFolderSweep:
    """Looks through the store part by part: 256 rounds see all of it."""

    def __init__(self, repository: Repository, folders: UnknownFolders, ages: Ages = AGES) -> None:
        self._repository = repository
        self._folders = folders
        self._ages = ages
        self._round = 0

    def sweep_a_part(self, now_s: float) -> None:
        """Look through the next part; now_s: time since 1970 [s]. Raises SQLAlchemyError, OSError."""
        prefix = PREFIXES[self._round % len(PREFIXES)]
        if prefix == PREFIXES[0]:
            self._look_at_those_apart(now_s)
        for folder in self._unknown(prefix, now_s):
            self._move_apart(folder)
        self._round += 1

    def sweep(self, now_s: float) -> None:
        """Look through the whole store. Raises SQLAlchemyError, OSError."""
        for _ in PREFIXES:
            self.sweep_a_part(now_s)

    def unknown(self, now_s: float) -> list[Folder]:
        """Return the folders that are old enough, and that the database does not know. Moves none."""
        return [folder for prefix in PREFIXES for folder in self._unknown(prefix, now_s)]

    def _unknown(self, prefix: str, now_s: float) -> list[Folder]:
        old = [
            folder
            for folder in self._folders.stored(prefix)
            if now_s - folder.since_s >= self._ages.settled_s
        ]
        known = self._repository.known_folders([folder.digest for folder in old])
        return [folder for folder in old if folder.digest not in known]

    def _move_apart(self, folder: Folder) -> None:
        try:
            is_known = self._repository.move_folder(
                folder.digest, apart=self._folders.move_apart, back=lambda _digest: None
            )
        except FileNotFoundError:  # somebody else has removed or moved it
            return
        if not is_known:
            log.warning(
                "the database does not know a folder of the recording store: moved apart",
                folder=folder.digest,
                to=self._folders.apart,
                size_bytes=folder.size_bytes,
                deleted_after_days=self._ages.kept_days,
            )

    def _look_at_those_apart(self, now_s: float) -> None:
        """Put back what the database knows by now, and delete what has lain apart for long."""
        apart = list(self._folders.set_apart())
        known = self._repository.known_folders([folder.digest for folder in apart])
        for folder in apart:
            if folder.digest in known:
                self._repository.move_folder(
                    folder.digest, apart=lambda _digest: None, back=self._folders.put_back
                )
                log.warning("the database knows a folder again: put back", folder=folder.digest)
            elif now_s - folder.since_s >= self._ages.kept_days * SECONDS_PER_DAY:
                self._folders.remove(folder.digest)
                log.warning("unknown folder deleted", folder=folder.digest, size_bytes=folder.size_bytes)
