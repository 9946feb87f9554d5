"""A PostgreSQL database in back-ups: each table as `COPY ... TO` writes it, all as of one time.

That needs no program of the server's version beside the service, and no right but to read.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import sqlalchemy
from alembic import command
from sqlalchemy import Connection, delete, func, inspect, select, text

from service.backup.database_copy import VERSION_TABLE, DatabaseCopy
from service.backup.errors import BackupError
from service.backup.layout import CHUNK_BYTES, DATABASE_FOLDER, PRIVATE_FOLDER, create, opened
from service.backup.manifest import TableCopy
from service.backup.verification import Verified
from service.storage import connect, migrations
from service.storage.database_url import readable_url
from service.storage.partitions import make, partitions, waiting


def copy_postgresql(url: str, folder: Path) -> DatabaseCopy:
    """Copy a database into a folder of a back-up while others write to it. Raises SQLAlchemyError."""
    folder.mkdir(mode=PRIVATE_FOLDER)
    engine = connect(url, limits=None)
    try:
        with engine.connect().execution_options(isolation_level="REPEATABLE READ") as connection:
            connection.execute(text("SET TRANSACTION READ ONLY"))
            (revision,) = connection.execute(text("SELECT version_num FROM alembic_version")).one()
            digests = _digests(connection)
            tables = {name: _copy_table(connection, name, folder) for name in _table_names(connection)}
    finally:
        engine.dispose()
    files = tuple(f"{folder.name}/{name}.copy" for name in tables)
    return DatabaseCopy("postgresql", revision, files, digests, tables)


class PostgresqlPlace:
    """A PostgreSQL database, which may have tables already."""

    def __init__(self, url: str) -> None:
        self._url = url

    def require_empty(self) -> None:
        """Raise BackupError where there are tables."""
        present = self.tables()
        if present:
            raise BackupError(
                f"{readable_url(self._url)}: the database has tables already, such as {min(present)}; "
                "with --overwrite all of them are replaced"
            )

    def tables(self) -> Sequence[str]:
        """Return the names of the tables that there are."""
        engine = connect(self._url)
        try:
            with engine.connect() as connection:
                return inspect(connection).get_table_names()
        finally:
            engine.dispose()

    def remove_all(self) -> None:
        """Drop all tables in one transaction. Raises BackupError where somebody else is connected."""
        engine = connect(self._url, limits=None)
        try:
            with engine.begin() as connection:
                self._require_alone(connection)
                self._drop_all(connection)
        finally:
            engine.dispose()

    def restore(self, backup: Verified) -> None:
        """Replace all tables in one transaction."""
        manifest = backup.manifest
        engine = connect(self._url, limits=None)
        try:
            with engine.begin() as connection:
                self._require_alone(connection)
                self._drop_all(connection)
                command.upgrade(migrations.config(connection), manifest.revision)
                self._load(connection, backup)
                self._require_listed(connection, backup)
        finally:
            engine.dispose()

    def _drop_all(self, connection: Connection) -> None:
        quote = connection.dialect.identifier_preparer.quote
        for table in (*_table_names(connection), VERSION_TABLE):
            connection.execute(text(f"DROP TABLE IF EXISTS {quote(table)} CASCADE"))
        functions = text(
            "SELECT oid::regprocedure FROM pg_proc WHERE pronamespace = current_schema()::regnamespace "
            "AND NOT EXISTS (SELECT FROM pg_depend WHERE objid = pg_proc.oid AND deptype = 'e')"
        )
        for function in connection.scalars(functions).all():  # those of triggers
            connection.execute(text(f"DROP FUNCTION {function} CASCADE"))

    def _require_alone(self, connection: Connection) -> None:
        others = connection.scalar(
            text(
                "SELECT count(*) FROM pg_stat_activity WHERE datname = current_database() "
                "AND pid <> pg_backend_pid() AND backend_type = 'client backend'"
            )
        )
        if others:
            raise BackupError(
                f"{readable_url(self._url)}: {others} other connections use this database: stop the services "
                "and gateways on it first"
            )

    def _load(self, connection: Connection, backup: Verified) -> None:
        manifest = backup.manifest
        tables = _table_names(connection)
        if set(tables) != manifest.tables.keys():
            odd = min(set(tables) ^ manifest.tables.keys())
            raise BackupError(
                f"{manifest.name}: expected the tables of revision {manifest.revision}, found a difference: "
                f"{odd}"
            )
        # Triggers keep the audit trail as it is, and a migration has put the first rows into some tables.
        self._switch_triggers(connection, tables, "DISABLE")
        for table in reversed(tables):
            connection.execute(delete(sqlalchemy.table(table)))
        for table in tables:
            self._load_table(connection, backup, table)
        self._switch_triggers(connection, tables, "ENABLE")
        make(connection, waiting(connection))

    def _switch_triggers(self, connection: Connection, tables: Sequence[str], switch: str) -> None:
        for table in tables:
            connection.execute(text(f"ALTER TABLE {table} {switch} TRIGGER USER"))

    def _load_table(self, connection: Connection, backup: Verified, table: str) -> None:
        told = backup.manifest.tables[table]
        columns = _columns_of(connection, table)
        if set(columns) != set(told.columns) or len(columns) != len(told.columns):
            raise BackupError(
                f"{backup.manifest.name}: table {table}: expected the columns {', '.join(columns)}, found "
                f"{', '.join(told.columns)}"
            )
        path = f"{backup.manifest.name}/{DATABASE_FOLDER}/{table}.copy"
        statement = f"COPY {_quoted_table(connection, table, told.columns)} FROM STDIN"
        with opened(backup.directory, path) as source, _cursor_of(connection) as cursor:
            with cursor.copy(statement) as rows:
                while chunk := source.read(CHUNK_BYTES):
                    rows.write(chunk)
            if cursor.rowcount != told.rows:
                raise BackupError(f"{path}: expected {told.rows} rows, found {cursor.rowcount}")
        self._continue_counting(connection, table, columns)

    def _continue_counting(self, connection: Connection, table: str, columns: list[str]) -> None:
        """Have numbers that the database gives go on behind those that were restored."""
        for column in columns:
            sequence = connection.scalar(
                text("SELECT pg_get_serial_sequence(:table, :column)"), {"table": table, "column": column}
            )
            if sequence is not None:
                largest = connection.scalar(
                    select(func.max(sqlalchemy.column(column))).select_from(sqlalchemy.table(table))
                )
                connection.execute(
                    text("SELECT setval(:sequence, :value, :used)"),
                    {"sequence": sequence, "value": largest or 1, "used": largest is not None},
                )

    def _require_listed(self, connection: Connection, backup: Verified) -> None:
        """Raise BackupError where the database names recordings that the back-up does not have."""
        named = _digests(connection)
        missing = named - backup.digests - {lost.digest for lost in backup.manifest.lost}
        if missing:
            raise BackupError(f"{backup.manifest.name}: it lacks recordings such as {min(missing)}")


def _digests(connection: Connection) -> frozenset[str]:
    """Return the digests of the recordings that the database names."""
    named = text("SELECT DISTINCT digest FROM recordings WHERE digest IS NOT NULL")
    return frozenset(connection.scalars(named))


def _table_names(connection: Connection) -> list[str]:
    """Return the tables of the database, each after those that it refers to.

    Their partitions are not among them: a table is copied with all of its rows, which find their partitions
    again, or wait for them in the default one.
    """
    names = [name for name, _ in inspect(connection).get_sorted_table_and_fkc_names() if name is not None]
    others = {VERSION_TABLE, *partitions(connection)}
    return [name for name in names if name not in others]


def _columns_of(connection: Connection, table: str) -> list[str]:
    """Return the columns of a table, in its order, without those that follow from others."""
    columns = inspect(connection).get_columns(table)
    return [column["name"] for column in columns if "computed" not in column]


def _copy_table(connection: Connection, table: str, folder: Path) -> TableCopy:
    columns = _columns_of(connection, table)
    quote = connection.dialect.identifier_preparer.quote
    # A table with partitions has no rows of its own to copy; a question finds those of all.
    every_row = f"SELECT {', '.join(map(quote, columns))} FROM {quote(table)}"  # noqa: S608 - our names
    cursor = _cursor_of(connection)
    with create(folder / f"{table}.copy") as file, cursor:
        with cursor.copy(f"COPY ({every_row}) TO STDOUT") as rows:
            for chunk in rows:
                file.write(chunk)
        return TableCopy(columns=columns, rows=cursor.rowcount)


def _quoted_table(connection: Connection, table: str, columns: list[str]) -> str:
    """Return the words of COPY that name a table with its columns."""
    quote = connection.dialect.identifier_preparer.quote
    return f"{quote(table)} ({', '.join(map(quote, columns))})"


def _cursor_of(connection: Connection) -> Any:
    """Return a cursor of psycopg, which can copy, in the transaction of a connection."""
    driver = connection.connection.driver_connection
    if driver is None:
        raise BackupError("the database does not answer")
    return driver.cursor()
