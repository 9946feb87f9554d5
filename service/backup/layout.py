"""Where things lie in a directory of back-ups.

    <directory>/statorwatch-backups                     marks it
    <directory>/lock                                    held while a back-up is made, verified or restored
    <directory>/recordings/<digest[:2]>/<digest>/...    the recordings of all back-ups, each once
    <directory>/backup-20261123T020000Z/manifest.json   what the back-up is (manifest.py)
                                        SHA256SUMS      all its files, as sha256sum --check reads them
                                        database.sqlite, or database/<table>.copy
                                        configuration/settings.toml, plant.scd, motors.toml
    <directory>/incomplete-.../                         a back-up while it is made

Whoever may write there could also write names that lead elsewhere. So a path counts only where it has one of
these forms, and is no link.
"""

import fcntl
import os
import re
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import BinaryIO

from service.backup.errors import BackupError

MARK = "statorwatch-backups"
MARK_TEXT = "Back-ups of StatorWatch (mcc backup). Move or copy this directory as a whole.\n"
LOCK = "lock"
POOL = "recordings"
MANIFEST = "manifest.json"
SUMS = "SHA256SUMS"
DATABASE_FILE = "database.sqlite"
DATABASE_FOLDER = "database"
CONFIGURATION = "configuration"
INCOMPLETE = "incomplete-"

NAME = re.compile(r"backup-[0-9]{8}T[0-9]{6}Z")
_FILE = r"[A-Z0-9_-][A-Z0-9._-]{0,99}"
_RECORDING = re.compile(rf"{POOL}/([0-9a-f]{{2}})/(\1[0-9a-f]{{62}})/({_FILE})")
_OWN = re.compile(
    rf"(?P<name>{NAME.pattern})/"
    rf"(?:{re.escape(DATABASE_FILE)}|{DATABASE_FOLDER}/[a-z][a-z0-9_]{{0,62}}\.copy|"
    rf"{CONFIGURATION}/(?:settings\.toml|plant\.scd|motors\.toml))"
)

PRIVATE_FOLDER, PRIVATE_FILE = 0o700, 0o600
CHUNK_BYTES = 1 << 20


@dataclass(frozen=True, slots=True)
class ListedFile:
    """A file of a back-up: its path below the directory of back-ups, and its SHA-256 (hexadecimal)."""

    path: str
    sha256: str

    @property
    def digest(self) -> str | None:
        """Return the digest of the recording that it belongs to; None for a file of the back-up's own."""
        match = _RECORDING.fullmatch(self.path)
        return None if match is None else match[2]

    @property
    def file_name(self) -> str:
        """Return its name without folders."""
        return self.path.rpartition("/")[2]


def is_path_of(path: str, backup: str) -> bool:
    """Tell whether a file of the back-up of this name may lie there."""
    own = _OWN.fullmatch(path)
    return own["name"] == backup if own is not None else _RECORDING.fullmatch(path) is not None


@contextmanager
def opened(root: Path, path: str) -> Iterator[BinaryIO]:
    """Open a file below `root` for reading; no part of its path may be a link. Raises BackupError."""
    folder = os.open(root, os.O_RDONLY | os.O_DIRECTORY)
    try:
        *folders, name = path.split("/")
        for part in folders:
            inner = os.open(part, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW, dir_fd=folder)
            os.close(folder)
            folder = inner
        file = os.open(name, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK, dir_fd=folder)
    except FileNotFoundError as error:
        raise BackupError(f"{root / path}: expected a file, found none") from error
    except OSError as error:  # a link where there may be none is ELOOP or ENOTDIR
        raise BackupError(
            f"{root / path}: expected a file that is no link, found: {error.strerror}"
        ) from error
    finally:
        os.close(folder)
    with os.fdopen(file, "rb") as stream:
        if not stat.S_ISREG(os.fstat(file).st_mode):
            raise BackupError(f"{root / path}: expected a file, found something else")
        yield stream


def hash_of(root: Path, path: str) -> tuple[str, int]:
    """Return the SHA-256 of a file and its size [bytes]. Raises BackupError."""
    digest, size_bytes = sha256(), 0
    with opened(root, path) as stream:
        while chunk := stream.read(CHUNK_BYTES):
            digest.update(chunk)
            size_bytes += len(chunk)
    return digest.hexdigest(), size_bytes


def create(path: Path) -> BinaryIO:
    """Open a new file that only its owner may read."""
    return os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, PRIVATE_FILE), "wb")


def backups_in(directory: Path) -> list[str]:
    """Return the names of the back-ups in a directory, oldest first. Raises BackupError (none of ours)."""
    require_mark(directory)
    return sorted(
        path.name
        for path in directory.iterdir()
        if NAME.fullmatch(path.name) and path.is_dir() and not path.is_symlink()
    )


def require_mark(directory: Path) -> None:
    """Raise BackupError unless the directory has back-ups."""
    if not (directory / MARK).is_file():
        found = "another one" if directory.is_dir() else "none"
        raise BackupError(
            f"{directory}: expected a directory of back-ups (mcc backup makes it), found {found}"
        )


def prepare(directory: Path) -> None:
    """Make a directory of back-ups of an empty or missing one. Raises BackupError, OSError."""
    try:
        directory.mkdir(mode=PRIVATE_FOLDER, parents=True, exist_ok=True)
    except OSError as error:
        raise BackupError(
            f"{directory}: the directory of the back-up cannot be made: {error.strerror}: expected one "
            "that is there, or that this user may make: look whether its disk is mounted, "
            "or name another directory"
        ) from error
    if not (directory / MARK).is_file():
        present = sorted(path.name for path in directory.iterdir() if path.name != "lost+found")
        if present:
            raise BackupError(
                f"{directory}: expected an empty directory or one of back-ups, found {present[0]} in it; "
                "name another directory, or a new one inside it"
            )
        with create(directory / MARK) as mark:
            mark.write(MARK_TEXT.encode())
    (directory / POOL).mkdir(mode=PRIVATE_FOLDER, exist_ok=True)


@contextmanager
def locked(directory: Path) -> Iterator[None]:
    """Hold the lock of a directory of back-ups. Raises BackupError where another process has it."""
    flags = os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW
    with os.fdopen(os.open(directory / LOCK, flags, PRIVATE_FILE), "r+b") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            raise BackupError(
                f"{directory}: another process makes, verifies or restores a back-up here; try again later"
            ) from error
        yield
