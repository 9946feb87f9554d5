"""Reads a copied SQLite file, whoever made it."""

import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

from service.backup.errors import BackupError


@contextmanager
def sqlite_opened(file: Path) -> Iterator[sqlite3.Connection]:
    """Open a copied database to read it, without a belief in what it says. Raises BackupError."""
    try:
        with closing(sqlite3.connect(f"{file.absolute().as_uri()}?mode=ro&immutable=1", uri=True)) as copy:
            copy.execute("PRAGMA trusted_schema = OFF")
            copy.execute("PRAGMA cell_size_check = ON")
            yield copy
    except (sqlite3.Error, TypeError) as error:  # the latter of a table without rows
        raise BackupError(f"{file}: expected a database of StatorWatch, found: {error}") from error


def digests_of(copy: sqlite3.Connection) -> frozenset[str]:
    """Return the digests of the recordings that a database names."""
    rows = copy.execute("SELECT DISTINCT digest FROM recordings WHERE digest IS NOT NULL")
    return frozenset(digest for (digest,) in rows)
