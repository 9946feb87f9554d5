"""Fetches the files of a recording from the service into a folder."""

import zipfile
from io import BytesIO
from pathlib import Path, PurePosixPath

from service.client.rest_client import ServiceClient, ServiceError

MOST_BYTES = 256 * 1024 * 1024
MOST_FILES = 16
READ_FROM = (".CFF", ".CFG", ".CEV")
"""A reader begins with one of these; the others belong to it."""


def download_recording(service: ServiceClient, recording_id: str, folder: Path) -> Path:
    """Write the files of a recording into a folder, and return the one that a reader begins with.

    Raises ServiceError, also for an archive that is none or too large; OSError.
    """
    path = f"/recordings/{recording_id}/file"
    with service.download_recording(recording_id) as file:
        archive = file.read()
    try:
        files = _unpacked(archive)
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError) as error:
        raise ServiceError(f"{path}: expected a ZIP archive, found {error}") from error
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        (folder / name).write_bytes(content)
    for suffix in READ_FROM:
        for name in files:
            if PurePosixPath(name).suffix.upper() == suffix:
                return folder / name
    raise ServiceError(
        f"{path}: expected a file of {', '.join(READ_FROM)}, found {', '.join(files) or 'none'}"
    )


def _unpacked(archive: bytes) -> dict[str, bytes]:
    """Return the files of an archive by their names. Raises ServiceError, BadZipFile, RuntimeError."""
    with zipfile.ZipFile(BytesIO(archive)) as opened:
        members = opened.infolist()
        size = sum(member.file_size for member in members)
        if len(members) > MOST_FILES or size > MOST_BYTES:
            raise ServiceError(
                f"expected at most {MOST_FILES} files of {MOST_BYTES} bytes together, found {len(members)} "
                f"of {size}"
            )
        for member in members:
            if member.filename in ("", ".", "..") or member.filename != PurePosixPath(member.filename).name:
                raise ServiceError(f"expected files without folders, found {member.filename!r}")
        return {member.filename: opened.read(member) for member in members}
