"""Where the files of event recordings are kept: what every such place offers, whoever keeps the files.

    <place>/<digest[:2]>/<digest>/C_0001.CFG, C_0001.DAT, C_0001.HDR
    <place>/unknown/<digest>/...                which the database does not know (unknown_folders.py)

The digest is the SHA-256 of the list of (name, SHA-256 of the content), so the same record is stored once
however often it is pulled. Rows of the database refer to it only once all of its files are safe at the place.
A folder (folder.py) and an S3-compatible store (bucket.py) give the files the same names, so that any tool
that copies one into the other moves an archive.
"""

import shutil
from abc import ABC, abstractmethod
from collections.abc import Mapping
from contextlib import AbstractContextManager
from pathlib import Path

from service.recording_store.arriving import Incoming
from service.recording_store.recording import Source, StoredRecording
from service.recording_store.unknown_folders import UnknownFolders


class RecordingStore(ABC):
    """Records by the digests of their contents. Several processes and hosts may store at once.

    Every method but `problem` raises OSError (StoreError) where the place does not do what it is asked.
    """

    @property
    @abstractmethod
    def place(self) -> str:
        """Return where the recordings are, for people."""

    @property
    @abstractmethod
    def written(self) -> tuple[Path, ...]:
        """Return the folders of this host that it writes to."""

    @property
    @abstractmethod
    def unknown(self) -> UnknownFolders:
        """Return the folders of contents, to be compared with the database."""

    @abstractmethod
    def problem(self) -> str | None:
        """Return why no recording can be read at present; None while all is well. Answers in seconds."""

    @abstractmethod
    def incoming(self) -> AbstractContextManager[Incoming]:
        """Provide a place for the files of one record; what is not kept is removed when the block ends."""

    @abstractmethod
    def find(self, digest: str) -> StoredRecording:
        """Return the record of a digest. Raises RecordingStoreError if its files are missing or changed."""

    @abstractmethod
    def source(self, digest: str) -> Source:
        """Name a record to whoever reads it. Raises RecordingStoreError where it is known to be missing."""

    @abstractmethod
    def discard_incoming(self) -> int:
        """Remove incomplete records of an earlier run of this writer. For use before anything is stored."""

    @abstractmethod
    def set_aside(self, digest: str) -> None:
        """Take the record of a digest away for good; it may be gone already.

        The caller holds the lock of the digest: nobody adds a row of this content meanwhile.
        """

    @abstractmethod
    def remove_set_aside(self, digest: str | None = None) -> None:
        """Remove what `set_aside` has left of a digest, or of all, also by others and before a crash."""

    def opened(self, digest: str) -> AbstractContextManager[Path]:
        """Provide the file that a reader opens first, on this host, while the block lasts.

        The other files of the record are beside it. Raises RecordingStoreError, OSError.
        """
        return self.source(digest).opened()

    def store(self, files: Mapping[str, Path | bytes]) -> StoredRecording:
        """Store the files (name in the record -> content or a file to copy) as one record."""
        with self.incoming() as incoming:
            for name, content in files.items():
                with incoming.create(name) as sink:
                    if isinstance(content, bytes):
                        sink.write(content)
                    else:
                        with content.open("rb") as source:
                            shutil.copyfileobj(source, sink)
            return incoming.keep()
