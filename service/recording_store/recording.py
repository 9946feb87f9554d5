"""A record that is stored, and who reads it where."""

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from service.recording_store.contents import WAVEFORM_SUFFIXES, StoredFile, entry_name


@dataclass(frozen=True, slots=True)
class StoredRecording:
    """A complete record in a store. is_there: asks the store whether it still has all of these files."""

    digest: str
    files: tuple[StoredFile, ...]
    is_there: Callable[[], bool] = field(compare=False, repr=False)

    @property
    def size_bytes(self) -> int:
        """Return the size of all files together [bytes]."""
        return sum(file.size_bytes for file in self.files)

    @property
    def name(self) -> str:
        """Return the record's name: that of its entry file without suffix."""
        return Path(self.entry_name).stem

    @property
    def entry_name(self) -> str:
        """Return the file that a reader opens first."""
        return entry_name(file.name for file in self.files)

    @property
    def waveform_files(self) -> tuple[StoredFile, ...]:
        """Return the files with the samples, without those that only describe them (.HDR, .INF)."""
        return tuple(file for file in self.files if Path(file.name).suffix in WAVEFORM_SUFFIXES)


class Source(Protocol):
    """Names a recording to whoever reads it, in any process; it can be pickled, and be a key."""

    def opened(self) -> AbstractContextManager[Path]:
        """Provide the file that a reader opens first, on this host, while the block lasts.

        Raises RecordingStoreError (its files are missing or changed), OSError.
        """
        ...

    def is_seen_here(self) -> bool:
        """Tell whether this host has a way to it; it does not look into a store for that."""
        ...

    def __hash__(self) -> int: ...


@dataclass(frozen=True, slots=True)
class LocalFile:
    """A recording in a folder that is visible under one path wherever it is read."""

    path: Path

    def __str__(self) -> str:
        return str(self.path)

    @contextmanager
    def opened(self) -> Iterator[Path]:
        """Provide the file itself; whoever reads it finds out whether it is there."""
        yield self.path

    def is_seen_here(self) -> bool:
        """Tell whether the file is there."""
        return self.path.exists()
