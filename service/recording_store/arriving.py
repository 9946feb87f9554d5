"""The files of one record while they arrive, in a folder of this host."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from service.recording_store.arriving_file import ArrivingFile
from service.recording_store.contents import StoredFile, entry_name, manifest_digest, safe_name
from service.recording_store.errors import RecordingStoreError
from service.recording_store.recording import StoredRecording

Keep = Callable[[Path, str, tuple[StoredFile, ...]], StoredRecording]
"""Moves the files of a folder, with this digest, to their place."""


class Incoming:
    """The files of one record while they arrive. `keep` moves them to their place; `close` always follows."""

    def __init__(self, directory: Path, keep: Keep) -> None:
        self._directory = directory
        self._keep = keep
        self._files: dict[str, StoredFile] = {}
        self._unsynced: list[ArrivingFile] = []

    @contextmanager
    def create(self, name: str) -> Iterator[ArrivingFile]:
        """Open a new file, which is whole when the block ends. Raises RecordingStoreError (bad name)."""
        path = self._directory / safe_name(name)
        try:
            sink = ArrivingFile(path)
        except FileExistsError as error:
            raise RecordingStoreError(f"{name!r}: this record already has a file {path.name}") from error
        self._unsynced.append(sink)  # it stays open: only this descriptor is told of an error in its writing
        yield sink
        self._files[path.name] = sink.finish()

    def sync(self) -> None:
        """Have the files on disk, as `keep` does. After an error nothing may be kept. Raises OSError."""
        for sink in self._unsynced:
            sink.sync()
        self.close()

    def sha256(self, name: str) -> str:
        """Return the SHA-256 of a file that was created here, hexadecimal."""
        return self._files[safe_name(name)].sha256

    def keep(self) -> StoredRecording:
        """Move the files to the place of their content, which may be there already.

        Raises RecordingStoreError (they are no record), OSError: nothing refers to what is there by then.
        """
        files = tuple(self._files[name] for name in sorted(self._files))
        entry_name(self._files)
        self.sync()
        return self._keep(self._directory, manifest_digest(files), files)

    def close(self) -> None:
        """Close the files, as far as they have come."""
        while self._unsynced:
            self._unsynced.pop().close()
