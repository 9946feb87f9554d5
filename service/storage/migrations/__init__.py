"""Brings a database to the tables of this version: `migrate(url)`, run at every start."""

from pathlib import Path

from alembic import command
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Connection

from service.storage.database_url import parsed_url
from service.storage.engine import connect, one_at_a_time
from service.storage.errors import StorageError

KEEP_EVERY_TEXT = frozenset({"UTF8", "SQL_ASCII"})
"""Encodings of a PostgreSQL server; the second one keeps the bytes that it gets."""

START_ONCE = "start the service once with these settings (mcc serve), which makes the tables"


def migrate(url: str, revision: str = "head") -> None:
    """Create the tables, or bring older ones up to date, or to an older revision that is newer than theirs.

    Do nothing where they are up to date. Raises StorageError (no such URL, another version's database, one
    that cannot hold every text), sqlalchemy.exc.SQLAlchemyError (the database does not answer).
    """
    # It may take minutes, and whoever starts at the same time waits for it.
    engine = connect(url, limits=None)
    try:
        with engine.begin() as connection:
            _require_unicode(connection)
            one_at_a_time(connection, "migrate")
            settings = config(connection)
            _require_known(connection, settings)
            command.upgrade(settings, revision)
    finally:
        engine.dispose()


def require_current_tables(url: str) -> None:
    """Raise StorageError unless the database is there and has the tables of this version. Change nothing.

    For a program that uses the database beside the service, which makes the tables. Raises
    sqlalchemy.exc.SQLAlchemyError (the database does not answer).
    """
    parsed = parsed_url(url)
    file = parsed.database or ""
    # To connect to an SQLite file makes it.
    if parsed.get_backend_name() == "sqlite" and not file.startswith("file:") and not Path(file).is_file():
        raise StorageError(f"database_url: expected an SQLite file, found none at {file}: {START_ONCE}")
    engine = connect(url)
    try:
        with engine.connect() as connection:
            settings = config(connection)
            _require_known(connection, settings)
            present = MigrationContext.configure(connection).get_current_revision()
    finally:
        engine.dispose()
    newest = ScriptDirectory.from_config(settings).get_current_head()
    if present != newest:
        found = "none" if present is None else f"those of revision {present}"
        raise StorageError(f"database_url: expected tables of revision {newest}, found {found}: {START_ONCE}")


def _require_unicode(connection: Connection) -> None:
    """Raise StorageError where the database would refuse a text because of a character in it."""
    if connection.dialect.name == "postgresql":
        encoding = connection.exec_driver_sql("SHOW server_encoding").scalar_one()
        if encoding not in KEEP_EVERY_TEXT:
            raise StorageError(
                f"database_url: expected a database in UTF8, found {encoding}: make one with "
                "createdb --encoding UTF8 --template template0"
            )


def _require_known(connection: Connection, settings: Config) -> None:
    """Raise StorageError for tables of another version, older or newer, that no migration leads on from."""
    present = MigrationContext.configure(connection).get_current_revision()
    known = [revision.revision for revision in ScriptDirectory.from_config(settings).walk_revisions()]
    if present is not None and present not in known:
        raise StorageError(
            f"database_url: expected tables of revision {known[0]}, found {present}: another version made "
            "them; start that one to export what you need, and this one with a new, empty database"
        )


def config(connection: Connection) -> Config:
    """Return Alembic's configuration for one connection; there is no alembic.ini."""
    settings = Config()
    settings.set_main_option("script_location", str(Path(__file__).parent).replace("%", "%%"))
    settings.set_main_option("path_separator", "os")
    settings.set_main_option("file_template", "v%%(rev)s_%%(slug)s")
    settings.attributes["connection"] = connection
    return settings
