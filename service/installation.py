"""The name of an installation of the service: one for each data directory, for ever."""

import uuid
from contextlib import suppress
from pathlib import Path

FILE = "installation"


def installation_id(data_directory: Path) -> str:
    """Read, or chosen the first time. Raises OSError where nothing can be kept."""
    path = data_directory / FILE
    with suppress(FileExistsError):
        chosen = path.with_name(f"{FILE}.{uuid.uuid4().hex}")
        chosen.write_text(f"{uuid.uuid4()}\n", encoding="ascii")
        try:
            path.hardlink_to(chosen)  # appears whole, and only for the first who tries
        finally:
            chosen.unlink()
    return path.read_text(encoding="ascii").strip()
