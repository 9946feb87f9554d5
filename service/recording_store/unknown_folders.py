"""Folders that the database does not know, moved out of the way.

    <place>/unknown/<digest>/...

They are kept there for a while: whoever starts the service with the wrong database, or with an old back-up of
it, gets them back.
"""

import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from service.recording_store.contents import content_directory, is_digest

PREFIXES = tuple(f"{number:02x}" for number in range(256))
"""The folders of the store that hold those named by their content."""

APART = "unknown"


@dataclass(frozen=True, slots=True)
class Folder:
    """A folder by its digest; when it was put where it is [s since 1970]; size of its files [bytes]."""

    digest: str
    since_s: float
    size_bytes: int


class UnknownFolders(Protocol):
    """The folders of a store, those known to the database and those moved out of the way."""

    @property
    def apart(self) -> str:
        """Return where those are that were moved out of the way, for people."""
        ...

    def stored(self, prefix: str) -> Iterator[Folder]:
        """Yield the folders whose digest begins so."""
        ...

    def set_apart(self) -> Iterator[Folder]:
        """Yield the folders that were moved out of the way."""
        ...

    def move_apart(self, digest: str) -> None:
        """Move a folder out of the way. Raises FileNotFoundError (it is gone), OSError."""
        ...

    def put_back(self, digest: str) -> None:
        """Move a folder back to its place, where the same content may be by now. Raises OSError."""
        ...

    def remove(self, digest: str) -> None:
        """Delete a folder that was moved out of the way. Raises OSError."""
        ...


class FolderUnknownFolders:
    """Folders below `root`. Moving one is one step: a crash leaves it in one place or the other."""

    def __init__(self, root: Path) -> None:
        self._root = root
        self._apart = root / APART

    @property
    def apart(self) -> str:
        return str(self._apart)

    def stored(self, prefix: str) -> Iterator[Folder]:
        """Yield the folders whose digest begins so."""
        return _folders(self._root / prefix)

    def set_apart(self) -> Iterator[Folder]:
        """Yield the folders that were moved out of the way."""
        return _folders(self._apart)

    def move_apart(self, digest: str) -> None:
        """Move a folder out of the way. Raises FileNotFoundError (it is gone), OSError."""
        directory = content_directory(self._root, digest)
        directory.stat()
        self._apart.mkdir(exist_ok=True)
        shutil.rmtree(self._apart / digest, ignore_errors=True)  # the same content, from an earlier time
        directory.rename(self._apart / digest)

    def put_back(self, digest: str) -> None:
        """Move a folder back to its place, where the same content may be by now. Raises OSError."""
        directory = content_directory(self._root, digest)
        if directory.is_dir():
            shutil.rmtree(self._apart / digest)
            return
        directory.parent.mkdir(exist_ok=True)
        (self._apart / digest).rename(directory)

    def remove(self, digest: str) -> None:
        """Delete a folder that was moved out of the way. Raises OSError."""
        shutil.rmtree(self._apart / digest)


def _folders(directory: Path) -> Iterator[Folder]:
    if not directory.is_dir():
        return
    for path in sorted(directory.iterdir()):
        if not is_digest(path.name) or not path.is_dir():  # whoever put it there may need it
            continue
        try:
            # A directory that is renamed has a new change time, whatever the times of its files.
            since_s = path.stat().st_ctime
            size_bytes = sum(file.stat().st_size for file in path.iterdir())
        except FileNotFoundError:  # removed meanwhile
            continue
        yield Folder(path.name, since_s, size_bytes)
