"""A new file while it arrives: it is hashed on its way, so that it is not read again."""

import os
from hashlib import sha256
from pathlib import Path

from service.recording_store.contents import StoredFile


class ArrivingFile:
    """Takes the bytes of a new file in their order. `finish`, then `sync`; `close` always follows.

    Its methods raise OSError where the disk does.
    """

    def __init__(self, path: Path) -> None:
        """Raises FileExistsError."""
        self._path = path
        self._file = path.open("xb")
        self._sha256 = sha256()
        self._size_bytes = 0

    def write(self, chunk: bytes, /) -> int:
        """Take some bytes."""
        self._file.write(chunk)
        self._sha256.update(chunk)
        self._size_bytes += len(chunk)
        return len(chunk)

    def finish(self) -> StoredFile:
        """Return what the file is, all of which the system has."""
        self._file.flush()
        return StoredFile(self._path.name, self._size_bytes, self._sha256.hexdigest())

    def sync(self) -> None:
        """Have it on disk."""
        os.fsync(self._file.fileno())

    def close(self) -> None:
        """Close the file, as far as it has come."""
        self._file.close()
