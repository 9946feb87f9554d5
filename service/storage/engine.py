"""Connections to the database. SQLite is shared by two processes: the service and its collector."""

import json
from functools import partial
from sqlite3 import Connection as SQLiteConnection

from sqlalchemy import Connection, Engine, create_engine, event, make_url
from sqlalchemy.engine.interfaces import DBAPIConnection
from sqlalchemy.exc import ArgumentError
from sqlalchemy.pool import ConnectionPoolEntry

from service.storage.errors import StorageError

BUSY_TIMEOUT_S = 30.0
WRITES = "statorwatch_writes"
"""Execution option of connections that will write."""


def connect(url: str) -> Engine:
    """Engine for an SQLAlchemy URL (SQLite or PostgreSQL). Raises StorageError for a URL that is none."""
    try:
        parsed = make_url(url)
    except ArgumentError as error:
        raise StorageError("database_url: expected a URL such as sqlite:////var/lib/mcc/db.sqlite") from error
    # A figure that is not a number has no place in a JSON document; better to fail here than in a reader.
    serializer = partial(json.dumps, allow_nan=False)
    if parsed.get_backend_name() != "sqlite":
        try:
            return create_engine(parsed, json_serializer=serializer, pool_pre_ping=True)
        except ModuleNotFoundError as error:
            raise StorageError(
                f"database_url: {parsed.drivername} needs the Python package {error.name!r}, which is not "
                "installed beside this service: pip install it there"
            ) from error
    if parsed.database in (None, "", ":memory:"):
        raise StorageError(
            "database_url: expected an SQLite file, found a database in memory (two processes use it)"
        )
    engine = create_engine(parsed, json_serializer=serializer, connect_args={"timeout": BUSY_TIMEOUT_S})
    event.listen(engine, "connect", _prepare_sqlite)
    event.listen(engine, "begin", _begin_sqlite)
    return engine


def _prepare_sqlite(connection: DBAPIConnection, entry: ConnectionPoolEntry) -> None:
    del entry
    if not isinstance(connection, SQLiteConnection) and not hasattr(connection, "isolation_level"):
        raise StorageError("database_url: expected Python's own SQLite driver")
    connection.isolation_level = (
        None  # transactions begin where _begin_sqlite says, not where the driver guesses
    )
    cursor = connection.cursor()
    # WAL: readers do not wait for the writer of the other process.
    # synchronous=FULL: an event report answered with 202 and a record whose EntryID the relay may forget
    # survive a power cut; NORMAL could lose the last commits. Few commits a second can afford an fsync each.
    for pragma in ("journal_mode=WAL", "synchronous=FULL", "foreign_keys=ON"):
        cursor.execute(f"PRAGMA {pragma}")
    cursor.close()


def _begin_sqlite(connection: Connection) -> None:
    # A transaction that reads first and writes later would fail at once (no wait) when the other process
    # wrote in between; taking the write lock at BEGIN waits for BUSY_TIMEOUT_S instead.
    writes = connection.get_execution_options().get(WRITES, False)
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")
