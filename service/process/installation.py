"""The identifier of an installation of the service, one for each data directory."""

import uuid
from contextlib import suppress
from pathlib import Path

FILE = "installation"


def installation_id(data_directory: Path) -> str:
    """Return the identifier, made at the first call. Raises OSError where it cannot be written then."""
    path = data_directory / FILE
    if not path.exists():
        chosen = path.with_name(f"{FILE}.{uuid.uuid4().hex}")
        try:
            chosen.write_text(f"{uuid.uuid4()}\n", encoding="ascii")
            with suppress(FileExistsError):
                path.hardlink_to(chosen)  # complete, and for the first process only
        finally:
            chosen.unlink(missing_ok=True)
    return path.read_text(encoding="ascii").strip()
