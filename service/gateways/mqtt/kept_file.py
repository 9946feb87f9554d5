"""Small documents in files of the data directory that outlive the gateway."""

import json
import os
from pathlib import Path

MOST_BYTES = 64 * 1024 * 1024


class KeptFileError(RuntimeError):
    """The file cannot be used; it says why."""


def read_kept(file: Path) -> dict[str, object] | None:
    """Return the document; None where there is none yet. Raises KeptFileError."""
    try:
        if file.stat().st_size > MOST_BYTES:
            raise KeptFileError(f"{file}: expected at most {MOST_BYTES} bytes, found more")
        found = json.loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    except (OSError, ValueError, RecursionError) as error:
        raise KeptFileError(f"{file}: expected a JSON document, found: {error}") from error
    if not isinstance(found, dict):
        raise KeptFileError(f"{file}: expected a table, found another document")
    return found


def write_kept(file: Path, document: dict[str, object]) -> None:
    """Replace the file at once: a reader, or a crash, sees the old or the new one. Raises OSError."""
    written = file.with_suffix(".new")
    with written.open("w", encoding="utf-8") as output:
        json.dump(document, output, ensure_ascii=False)
        output.flush()
        os.fsync(output.fileno())
    written.replace(file)
