"""Recordings in a folder, which several hosts may share.

    <root>/<digest[:2]>/<digest>/C_0001.CFG, C_0001.DAT, C_0001.HDR
    <root>/incoming/<writer>/<random>/...      while they arrive
    <root>/deleted/<digest>.<random>/...       while they are removed
    <root>/unknown/<digest>/...                which the database does not know (unknown_folders.py)

A folder appears under its digest only when it is complete and on disk (fsync).
"""

import os
import shutil
import uuid
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

from service.recording_store.arriving import Incoming
from service.recording_store.contents import (
    StoredFile,
    content_directory,
    describe,
    entry_name,
    manifest_digest,
)
from service.recording_store.errors import RecordingStoreError
from service.recording_store.recording import LocalFile, StoredRecording
from service.recording_store.store import RecordingStore
from service.recording_store.unknown_folders import FolderUnknownFolders

ASIDE = "deleted"
"""Below this folder everything may be removed, whoever put it there."""


class FolderStore(RecordingStore):
    """Folders below `root`, named by their content. Several processes may store at once.

    writer: a name that no other process uses at the same time, and that this one uses again after a restart.
    """

    def __init__(self, root: Path, writer: str = "service") -> None:
        self.root = root
        self._incoming = root / "incoming" / writer
        self._incoming.mkdir(parents=True, exist_ok=True)

    @property
    def place(self) -> str:
        return str(self.root)

    @property
    def written(self) -> tuple[Path, ...]:
        return (self.root,)

    @property
    def unknown(self) -> FolderUnknownFolders:
        return FolderUnknownFolders(self.root)

    def problem(self) -> str | None:
        """Tell whether the folder is the store's: that of a file system that is not mounted is empty."""
        if self._incoming.parent.is_dir():
            return None
        return f"{self.root}: expected the folder of the recordings, found none: is it mounted?"

    @contextmanager
    def incoming(self) -> Iterator[Incoming]:
        directory = self._incoming / uuid.uuid4().hex
        directory.mkdir()
        try:
            with closing(Incoming(directory, self._keep)) as incoming:
                yield incoming
        finally:
            shutil.rmtree(directory, ignore_errors=True)

    def find(self, digest: str) -> StoredRecording:
        directory = self._present(digest)
        files = describe(directory)
        if manifest_digest(files) != digest:
            raise RecordingStoreError(f"recording {digest}: its files in {directory} are not those stored")
        return self._stored(digest, files)

    def source(self, digest: str) -> LocalFile:
        return LocalFile(self.entry(digest))

    def entry(self, digest: str) -> Path:
        """Return the file that a reader opens first, without hashing any. Raises RecordingStoreError."""
        directory = self._present(digest)
        return directory / entry_name(path.name for path in directory.iterdir())

    def directory(self, digest: str) -> Path:
        """Return where the files of a digest are, if they are stored."""
        return content_directory(self.root, digest)

    def discard_incoming(self) -> int:
        left_over = list(self._incoming.iterdir())
        for directory in left_over:
            shutil.rmtree(directory)
        return len(left_over)

    def set_aside(self, digest: str) -> None:
        aside = self.root / ASIDE
        aside.mkdir(exist_ok=True)
        directory = self.directory(digest)
        if not directory.is_dir():
            return
        directory.rename(aside / f"{digest}.{uuid.uuid4().hex}")
        _sync_directory(aside)
        _sync_directory(directory.parent)

    def remove_set_aside(self, digest: str | None = None) -> None:
        aside = self.root / ASIDE
        if aside.is_dir():
            for directory in aside.glob("*" if digest is None else f"{digest}.*"):
                shutil.rmtree(directory, ignore_errors=True)

    def _keep(self, arrived: Path, digest: str, files: tuple[StoredFile, ...]) -> StoredRecording:
        """Move the folder of the files that arrived to the folder of their content."""
        directory = self.directory(digest)
        if not directory.is_dir():
            directory.parent.mkdir(exist_ok=True)
            _sync_directory(arrived)
            _sync_directory(self.root)
            try:
                arrived.rename(directory)
            except OSError:
                if not directory.is_dir():  # otherwise another process stored the same content first
                    raise
        _sync_directory(directory.parent)
        return self._stored(digest, files)

    def _stored(self, digest: str, files: tuple[StoredFile, ...]) -> StoredRecording:
        return StoredRecording(digest, files, self.directory(digest).is_dir)

    def _present(self, digest: str) -> Path:
        directory = self.directory(digest)
        if not directory.is_dir():
            raise RecordingStoreError(f"recording {digest}: its files are missing from {self.root}")
        return directory


def _sync_directory(directory: Path) -> None:
    descriptor = os.open(directory, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
