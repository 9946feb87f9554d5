"""The files of event recordings, in folders named by their content.

    <root>/<digest[:2]>/<digest>/C_0001.CFG, C_0001.DAT, C_0001.HDR
    <root>/incoming/<writer>/<random>/...      while they arrive
    <root>/deleted/<digest>.<random>/...       while they are removed
    <root>/unknown/<digest>/...                which the database does not know (unknown_folders.py)

The digest is the SHA-256 of the list of (name, SHA-256 of the content), so the same record is stored once
however often it is pulled. A folder appears under its digest only when it is complete and on disk (fsync).
From then on rows of the database may refer to it.
"""

import os
import re
import shutil
import uuid
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from hashlib import file_digest, sha256
from pathlib import Path
from typing import BinaryIO

ENTRY_SUFFIXES = (".CFG", ".CFF", ".CEV")
WAVEFORM_SUFFIXES = (*ENTRY_SUFFIXES, ".DAT")
MAX_NAME_LENGTH = 100
ASIDE = "deleted"
"""Below this folder everything may be removed, whoever put it there."""
_DIGEST = re.compile(r"[0-9a-f]{64}")


class RecordingStoreError(ValueError):
    """Files cannot be stored, or stored files are missing or changed."""


@dataclass(frozen=True, slots=True)
class StoredFile:
    """One file of a record: its name as stored, size [bytes] and SHA-256 (hexadecimal)."""

    name: str
    size_bytes: int
    sha256: str


@dataclass(frozen=True, slots=True)
class StoredRecording:
    """A complete record on disk."""

    digest: str
    directory: Path
    files: tuple[StoredFile, ...]

    @property
    def size_bytes(self) -> int:
        """Return the size of all files together [bytes]."""
        return sum(file.size_bytes for file in self.files)

    @property
    def name(self) -> str:
        """Return the record's name: that of its entry file without suffix."""
        return self.entry.stem

    @property
    def waveform_files(self) -> tuple[StoredFile, ...]:
        """Return the files with the samples, without those that only describe them (.HDR, .INF)."""
        return tuple(file for file in self.files if Path(file.name).suffix in WAVEFORM_SUFFIXES)

    @property
    def entry(self) -> Path:
        """Return the file that a reader opens first (.CFG, .CFF or .CEV)."""
        return _entry(self.directory, (file.name for file in self.files))


class Incoming:
    """The files of one record while they arrive. `keep` moves them to their place."""

    def __init__(self, directory: Path, root: Path) -> None:
        self._directory = directory
        self._root = root

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
        return _sha256(self._directory / safe_name(name))

    def keep(self) -> StoredRecording:
        """Move the files to the folder of their content, which may be there already."""
        files = _describe(self._directory)
        _entry(self._directory, (file.name for file in files))
        digest = manifest_digest(files)
        directory = content_directory(self._root, digest)
        if not directory.is_dir():
            directory.parent.mkdir(exist_ok=True)
            _sync_directory(self._directory)
            _sync_directory(self._root)
            try:
                self._directory.rename(directory)
            except OSError:
                if not directory.is_dir():  # otherwise another process stored the same content first
                    raise
        _sync_directory(directory.parent)
        return StoredRecording(digest, directory, files)


class RecordingStore:
    """Folders below `root`, named by their content. Several processes may store at once.

    writer: a name that no other process uses at the same time, and that this one uses again after a restart.
    """

    def __init__(self, root: Path, writer: str = "service") -> None:
        self.root = root
        self._incoming = root / "incoming" / writer
        self._incoming.mkdir(parents=True, exist_ok=True)

    def is_there(self) -> bool:
        """Tell whether the folder is the store's: that of a file system that is not mounted is empty."""
        return self._incoming.parent.is_dir()

    @contextmanager
    def incoming(self) -> Iterator[Incoming]:
        """Provide a place for the files of one record; what is not kept is removed when the block ends."""
        directory = self._incoming / uuid.uuid4().hex
        directory.mkdir()
        try:
            yield Incoming(directory, self.root)
        finally:
            shutil.rmtree(directory, ignore_errors=True)

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

    def find(self, digest: str) -> StoredRecording:
        """Return the record of a digest. Raises RecordingStoreError if its files are missing or changed."""
        directory = self._present(digest)
        files = _describe(directory)
        if manifest_digest(files) != digest:
            raise RecordingStoreError(f"recording {digest}: its files in {directory} are not those stored")
        return StoredRecording(digest, directory, files)

    def entry(self, digest: str) -> Path:
        """Return the file that a reader opens first, without hashing any. Raises RecordingStoreError."""
        directory = self._present(digest)
        return _entry(directory, (path.name for path in directory.iterdir()))

    def discard_incoming(self) -> int:
        """Remove incomplete records of an earlier run of this writer. For use before anything is stored."""
        left_over = list(self._incoming.iterdir())
        for directory in left_over:
            shutil.rmtree(directory)
        return len(left_over)

    def set_aside(self, digest: str) -> None:
        """Take the record of a digest away, at once and as a whole, to be removed; it may be gone already."""
        aside = self.root / ASIDE
        aside.mkdir(exist_ok=True)
        directory = content_directory(self.root, digest)
        if not directory.is_dir():
            return
        directory.rename(aside / f"{digest}.{uuid.uuid4().hex}")
        _sync_directory(aside)
        _sync_directory(directory.parent)

    def remove_set_aside(self, digest: str | None = None) -> None:
        """Remove what was set aside of a digest, or of all, also by others and before a crash."""
        aside = self.root / ASIDE
        if aside.is_dir():
            for directory in aside.glob("*" if digest is None else f"{digest}.*"):
                shutil.rmtree(directory, ignore_errors=True)

    def _present(self, digest: str) -> Path:
        directory = content_directory(self.root, digest)
        if not directory.is_dir():
            raise RecordingStoreError(f"recording {digest}: its files are missing from {self.root}")
        return directory


def safe_name(name: str) -> str:
    """Return the name to store a file under: the end of its path in upper case and portable characters.

    Names come from relays and uploads and cannot be trusted; this one stays inside the record's folder.
    """
    last = re.split(r"[\\/]", name)[-1]
    safe = re.sub(r"[^A-Z0-9._-]", "_", last.upper())
    if not safe.strip("._") or safe.startswith(".") or len(safe) > MAX_NAME_LENGTH:
        raise RecordingStoreError(
            f"{name[:200]!r}: expected a file name of 1 to {MAX_NAME_LENGTH} characters such as C_0001.CFG"
        )
    return safe


def manifest_digest(files: tuple[StoredFile, ...]) -> str:
    """Return the SHA-256 of the sorted (name, SHA-256) of the files, hexadecimal."""
    lines = sorted(f"{file.name}\t{file.sha256}\n" for file in files)
    return sha256("".join(lines).encode("ascii")).hexdigest()


def waveform_digest(files: Iterable[StoredFile]) -> str:
    """Return the SHA-256 of the contents of the files with the samples, whatever the files are called."""
    contents = sorted(file.sha256 for file in files if Path(file.name).suffix in WAVEFORM_SUFFIXES)
    return sha256("\n".join(contents).encode("ascii")).hexdigest()


def is_digest(name: str) -> bool:
    """Return whether this may be the name of a folder of a content."""
    return _DIGEST.fullmatch(name) is not None


def content_directory(root: Path, digest: str) -> Path:
    """Return the folder of a content below the root of a store. Raises RecordingStoreError (no digest)."""
    if not is_digest(digest):
        raise RecordingStoreError(f"{digest[:80]!r}: expected a SHA-256 digest of 64 hexadecimal digits")
    return root / digest[:2] / digest


def _describe(directory: Path) -> tuple[StoredFile, ...]:
    files = []
    for path in sorted(directory.iterdir()):
        files.append(StoredFile(path.name, path.stat().st_size, _sha256(path)))
    return tuple(files)


def _sha256(path: Path) -> str:
    with path.open("rb") as stream:
        return file_digest(stream, "sha256").hexdigest()


def _entry(directory: Path, names: Iterator[str]) -> Path:
    entries = sorted(name for name in names if Path(name).suffix in ENTRY_SUFFIXES)
    if len(entries) != 1:
        raise RecordingStoreError(
            f"a record has exactly one file that ends in {', '.join(ENTRY_SUFFIXES)}; "
            f"found {', '.join(entries) or 'none'}"
        )
    return directory / entries[0]


def _sync_directory(directory: Path) -> None:
    descriptor = os.open(directory, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
