"""The name of an installation of the service: one for each data directory, for ever."""

import uuid
from contextlib import suppress
from pathlib import Path

FILE = "installation"


def installation_id(data_directory: Path) -> str:
    """Read, or chosen the first time. Raises OSError where nothing can be kept then."""
    path = data_directory / FILE
    if not path.exists():
        chosen = path.with_name(f"{FILE}.{uuid.uuid4().hex}")
        try:
            chosen.write_text(f"{uuid.uuid4()}\n", encoding="ascii")
            with suppress(FileExistsError):
                path.hardlink_to(chosen)  # appears whole, and only for the first who tries
        finally:
            chosen.unlink(missing_ok=True)
    return path.read_text(encoding="ascii").strip()
