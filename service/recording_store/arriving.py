"""The files of one record while they arrive, in a folder of this host."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from service.recording_store.contents import (
    StoredFile,
    describe,
    entry_name,
    hash_of_file,
    manifest_digest,
    safe_name,
)
from service.recording_store.errors import RecordingStoreError
from service.recording_store.recording import StoredRecording

Keep = Callable[[Path, str, tuple[StoredFile, ...]], StoredRecording]
"""Moves the files of a folder, with this digest, to their place."""


class Incoming:
    """The files of one record while they arrive. `keep` moves them to their place."""

    def __init__(self, directory: Path, keep: Keep) -> None:
        self._directory = directory
        self._keep = keep

    @contextmanager
    def create(self, name: str) -> Iterator[BinaryIO]:
        """Open a new file, which is on disk when the block ends. Raises RecordingStoreError (bad name)."""
        path = self._directory / safe_name(name)
        try:
            sink = path.open("xb")
        except FileExistsError as error:
            raise RecordingStoreError(f"{name!r}: this record already has a file {path.name}") from error
        with sink:
            yield sink
            sink.flush()
            os.fsync(sink.fileno())

    def sha256(self, name: str) -> str:
        """Return the SHA-256 of a file that was created here, hexadecimal."""
        return hash_of_file(self._directory / safe_name(name))

    def keep(self) -> StoredRecording:
        """Move the files to the place of their content, which may be there already.

        Raises RecordingStoreError (they are no record), OSError: nothing refers to what is there by then.
        """
        files = describe(self._directory)
        entry_name(file.name for file in files)
        return self._keep(self._directory, manifest_digest(files), files)
