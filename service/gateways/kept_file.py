"""Small files in the data directory that outlive the gateway, each replaced as a whole."""

import csv
import io
import json
import os
from collections.abc import Iterable, Mapping, Sequence
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


def write_kept(file: Path, document: Mapping[str, object]) -> None:
    """Keep a document. Raises OSError."""
    replace_file(file, json.dumps(document, ensure_ascii=False).encode())


def write_table(file: Path, heading: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """Keep a table as CSV, for people who set up the other system. Raises OSError."""
    text = io.StringIO(newline="")
    table = csv.writer(text)
    table.writerow(heading)
    table.writerows(rows)
    replace_file(file, text.getvalue().encode())


def replace_file(file: Path, content: bytes) -> None:
    """Replace the file at once: a reader, or a crash, sees the old or the new one. Raises OSError.

    Its owner alone may read it.
    """
    written = file.with_suffix(".new")
    written.unlink(missing_ok=True)
    written.touch(mode=0o600)
    with written.open("wb") as output:
        output.write(content)
        output.flush()
        os.fsync(output.fileno())
    written.replace(file)
