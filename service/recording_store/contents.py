"""What a record consists of: its files, the names they are stored under, and the digest that names it all."""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from hashlib import file_digest, sha256
from pathlib import Path

from core.recordings.reading import SUFFIXES
from service.recording_store.errors import RecordingStoreError

ENTRY_SUFFIXES = tuple(suffix.upper() for suffix in SUFFIXES)
WAVEFORM_SUFFIXES = (*ENTRY_SUFFIXES, ".DAT")
MAX_NAME_LENGTH = 100
_DIGEST = re.compile(r"[0-9a-f]{64}")


@dataclass(frozen=True, slots=True)
class StoredFile:
    """One file of a record: its name as stored, size [bytes] and SHA-256 (hexadecimal)."""

    name: str
    size_bytes: int
    sha256: str


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


def is_stored_name(name: str) -> bool:
    """Return whether a file of a record may be called so in a store."""
    try:
        return safe_name(name) == name
    except RecordingStoreError:
        return False


def manifest_digest(files: Iterable[StoredFile]) -> str:
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


def require_digest(digest: str) -> str:
    """Return the digest. Raises RecordingStoreError where it is none."""
    if not is_digest(digest):
        raise RecordingStoreError(f"{digest[:80]!r}: expected a SHA-256 digest of 64 hexadecimal digits")
    return digest


def content_directory(root: Path, digest: str) -> Path:
    """Return the folder of a content below the root of a store. Raises RecordingStoreError (no digest)."""
    return root / require_digest(digest)[:2] / digest


def entry_name(names: Iterable[str]) -> str:
    """Return the file that a reader opens first (ENTRY_SUFFIXES). Raises RecordingStoreError."""
    entries = sorted(name for name in names if Path(name).suffix in ENTRY_SUFFIXES)
    if len(entries) != 1:
        raise RecordingStoreError(
            f"a record has exactly one file that ends in {', '.join(ENTRY_SUFFIXES)}; "
            f"found {', '.join(entries) or 'none'}"
        )
    return entries[0]


def describe(directory: Path) -> tuple[StoredFile, ...]:
    """Return the files of a folder, every one read."""
    return tuple(
        StoredFile(path.name, path.stat().st_size, hash_of_file(path)) for path in sorted(directory.iterdir())
    )


def hash_of_file(path: Path) -> str:
    """Return the SHA-256 of a file, hexadecimal."""
    with path.open("rb") as stream:
        return file_digest(stream, "sha256").hexdigest()
