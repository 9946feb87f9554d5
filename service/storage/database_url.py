"""The URL of the database, which may hold a password: it is never printed as it is, even if it is wrong."""

from sqlalchemy import URL, make_url
from sqlalchemy.exc import ArgumentError

from service.storage.errors import StorageError

EXAMPLE = "sqlite:////var/lib/mcc/db.sqlite"
POSTGRESQL = "postgresql+psycopg"
DRIVERS = ("sqlite", "sqlite+pysqlite", "postgresql", POSTGRESQL)
"""The databases that the service is tested with, and what connects to them."""

LONGEST_QUOTED = 40


def parsed_url(text: str) -> URL:
    """Return an SQLAlchemy URL. Raises StorageError, which tells no password of the text.

    A password with an @ of its own would end early, and its rest would be taken for the host, which many
    messages name.
    """
    try:
        url = make_url(text)
    except (ArgumentError, ValueError):  # the latter quotes what it took for a port
        raise StorageError(
            f"database_url: expected a URL such as {EXAMPLE}; in a user's name or password write "
            "@ as %40, : as %3A and / as %2F"
        ) from None
    if url.drivername not in DRIVERS:
        raise _wrong_database(url)
    if url.get_backend_name() != "sqlite" and any("@" in (part or "") for part in (url.host, url.database)):
        raise StorageError(
            "database_url: expected one @, in front of the host; in a user's name or password write @ as %40"
        )
    return url


def _wrong_database(url: URL) -> StorageError:
    """Return the refusal of a database that is none of the known ones; of postgres:// it names the cure."""
    found = url.drivername[:LONGEST_QUOTED]
    if found.startswith("postgres"):
        return StorageError(
            f"database_url: expected {POSTGRESQL}:// in front of a PostgreSQL database, found {found}://; "
            f"write {POSTGRESQL}://USER:PASSWORD@HOST:PORT/DATABASE"
        )
    return StorageError(
        f"database_url: expected sqlite:///FILE or {POSTGRESQL}://USER:PASSWORD@HOST:PORT/DATABASE, "
        f"found {found}://"
    )


def readable_url(text: str) -> str:
    """Return the URL without password and options, for people. Raises StorageError."""
    return parsed_url(text).set(query={}).render_as_string(hide_password=True)
