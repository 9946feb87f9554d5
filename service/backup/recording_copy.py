"""One recording copied from one store to another: from the plant into the back-up, or back.

Both have the recordings in folders named by their content. A folder appears under that name only when its
files are complete and are what the name says.
"""

import os
import shutil
import uuid
from hashlib import sha256
from pathlib import Path

from service.backup.errors import BackupError
from service.backup.layout import CHUNK_BYTES, PRIVATE_FOLDER, create, hash_of, opened
from service.recording_store.contents import StoredFile, content_directory, manifest_digest, safe_name
from service.recording_store.errors import RecordingStoreError

MOST_FILES = 100
"""A record has two or three."""


def files_of(root: Path, digest: str) -> tuple[StoredFile, ...]:
    """Return the files of a recording, every one read. Raises BackupError where they are not those stored."""
    folder = content_directory(root, digest)
    names = _names(folder)
    relative = folder.relative_to(root).as_posix()
    files = []
    for name in names:
        digest_of_file, size_bytes = hash_of(root, f"{relative}/{name}")
        files.append(StoredFile(name, size_bytes, digest_of_file))
    return _checked(tuple(files), folder, digest)


def copy_recording(source: Path, target: Path, staging: Path, digest: str) -> tuple[StoredFile, ...]:
    """Copy the folder of a digest from one store to another. Return its files.

    staging: a folder on the disk of `target`. What is not complete is left there after a crash. Raises
    BackupError where the files of the source are missing or not those stored, OSError.
    """
    folder = content_directory(source, digest)
    names = _names(folder)
    relative = folder.relative_to(source).as_posix()
    arriving = staging / uuid.uuid4().hex
    arriving.mkdir(mode=PRIVATE_FOLDER, parents=True)
    try:
        files = tuple(_copy(source, f"{relative}/{name}", arriving / name) for name in names)
        _checked(files, folder, digest)
        place = content_directory(target, digest)
        place.parent.mkdir(mode=PRIVATE_FOLDER, exist_ok=True)
        try:
            arriving.rename(place)
        except OSError:
            if not place.is_dir():  # otherwise somebody else stored the same content first
                raise
    finally:
        shutil.rmtree(arriving, ignore_errors=True)
    return files


def _names(folder: Path) -> list[str]:
    if folder.is_symlink() or folder.parent.is_symlink():
        raise BackupError(f"{folder}: expected a folder that is no link")
    try:
        names = sorted(entry.name for entry in os.scandir(folder))
    except FileNotFoundError as error:
        raise BackupError(f"{folder}: expected the files of a recording, found none") from error
    except NotADirectoryError as error:
        raise BackupError(f"{folder}: expected a folder, found something else") from error
    if len(names) > MOST_FILES:
        raise BackupError(f"{folder}: expected at most {MOST_FILES} files, found {len(names)}")
    for name in names:
        if not _is_stored_name(name):
            raise BackupError(f"{folder}: expected files such as C_0001.CFG, found {name[:100]!r}")
    return names


def _is_stored_name(name: str) -> bool:
    try:
        return safe_name(name) == name
    except RecordingStoreError:
        return False


def _checked(files: tuple[StoredFile, ...], folder: Path, digest: str) -> tuple[StoredFile, ...]:
    if manifest_digest(files) != digest:
        raise BackupError(f"{folder}: its files are not those that were stored: their hashes differ")
    return files


def _copy(root: Path, path: str, target: Path) -> StoredFile:
    digest, size_bytes = sha256(), 0
    with opened(root, path) as source, create(target) as sink:
        while chunk := source.read(CHUNK_BYTES):
            digest.update(chunk)
            size_bytes += len(chunk)
            sink.write(chunk)
    return StoredFile(target.name, size_bytes, digest.hexdigest())
