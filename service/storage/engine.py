"""Connections to the database. SQLite is shared by two processes: the service and its collector."""

import json
import sqlite3
import time
from collections.abc import Mapping
from functools import partial

from pydantic_core import from_json
from sqlalchemy import Connection, Engine, create_engine, event, func, select
from sqlalchemy.engine.interfaces import DBAPIConnection
from sqlalchemy.pool import ConnectionPoolEntry

from service.storage.database_url import POSTGRESQL, parsed_url
from service.storage.errors import StorageError
from service.storage.postgresql_sessions import parameters, tell_of_ends
from service.storage.transaction_limits import USUAL, TransactionLimits

BUSY_TIMEOUT_S = 30.0
"""A transaction waits at most this long while others write to an SQLite file."""

LOOK_S = 0.003
"""A waiting writer looks this often whether SQLite's write lock is free."""

LARGEST_LOG_BYTES = 64 * 1024**2
"""SQLite cuts its write-ahead log to this size when it begins it anew."""

WRITES = "statorwatch_writes"
"""This execution option marks connections that will write."""

WAITS_S = "statorwatch_busy_timeout_s"
"""This execution option says how long a writing connection waits for its turn [s]."""


def connect(
    url: str, *, busy_timeout_s: float = BUSY_TIMEOUT_S, limits: TransactionLimits | None = USUAL
) -> Engine:
    """Return the engine for an SQLAlchemy URL (SQLite or PostgreSQL).

    busy_timeout_s: how long a transaction waits while others write to an SQLite file. limits: of transactions
    on PostgreSQL; None for work that nobody else does at the same time, which may take as long as it does.
    Raises StorageError for what is no URL.
    """
    parsed = parsed_url(url)
    # A figure that is not a number has no place in a JSON document; better to fail here than in a reader.
    serializer = partial(json.dumps, allow_nan=False)
    if parsed.get_backend_name() != "sqlite":
        if parsed.drivername == "postgresql":
            parsed = parsed.set(drivername=POSTGRESQL)
        try:
            engine = create_engine(
                parsed.set(query=parameters(parsed.query, limits)),
                json_serializer=serializer,
                json_deserializer=_decoded,
                pool_pre_ping=True,
            )
        except ModuleNotFoundError as error:
            raise StorageError(
                f"database_url: {parsed.drivername} needs the Python package {error.name!r}, which is not "
                "installed beside this service: pip install it there"
            ) from error
        tell_of_ends(engine)
        return engine
    if parsed.database in (None, "", ":memory:"):
        raise StorageError(
            "database_url: expected an SQLite file, found a database in memory (two processes use it)"
        )
    engine = create_engine(
        parsed,
        json_serializer=serializer,
        json_deserializer=_decoded,
        connect_args={"timeout": busy_timeout_s},
        execution_options={WAITS_S: busy_timeout_s},
    )
    event.listen(engine, "connect", _prepare_sqlite)
    event.listen(engine, "begin", _begin_sqlite)
    return engine


def busy_timeout_s_of(options: Mapping[str, object]) -> float:
    """Return how long a transaction waits for its turn, from the execution options of an engine [s]."""
    timeout_s = options.get(WAITS_S, BUSY_TIMEOUT_S)
    assert isinstance(timeout_s, float)  # noqa: S101 - `connect` has set it
    return timeout_s


def _decoded(text: str | bytes) -> object:
    """Return what a JSON document says, in half the time of `json.loads`.

    Half of a surrogate pair is no Unicode, which `from_json` insists on.
    """
    try:
        found: object = from_json(text)
    except ValueError:
        return json.loads(text)
    return found


def one_at_a_time(connection: Connection, work: str) -> None:
    """Wait until no other transaction does this work; for what two services may begin at the same time."""
    if connection.dialect.name == "postgresql":
        connection.execute(select(func.pg_advisory_xact_lock(func.hashtext(f"statorwatch {work}"))))


def _prepare_sqlite(connection: DBAPIConnection, entry: ConnectionPoolEntry) -> None:
    del entry
    if not isinstance(connection, sqlite3.Connection) and not hasattr(connection, "isolation_level"):
        raise StorageError("database_url: expected Python's own SQLite driver")
    connection.isolation_level = (
        None  # transactions begin where _begin_sqlite says, not where the driver guesses
    )
    cursor = connection.cursor()
    # WAL: readers do not wait for the writer of the other process.
    # synchronous=FULL: a request answered with 202 and a record whose EntryID the relay may forget
    # survive a power cut; NORMAL could lose the last commits. Few commits a second can afford an fsync each.
    # journal_size_limit: the log that one long transaction has made large does not stay so for ever.
    journal_size_limit = f"journal_size_limit={LARGEST_LOG_BYTES}"
    for pragma in ("journal_mode=WAL", "synchronous=FULL", "foreign_keys=ON", journal_size_limit):
        cursor.execute(f"PRAGMA {pragma}")
    cursor.close()


def _begin_sqlite(connection: Connection) -> None:
    # A transaction that reads first and writes later would fail at once (no wait) when the other process
    # wrote in between; taking the write lock at BEGIN waits for the busy timeout instead.
    if not connection.get_execution_options().get(WRITES, False):
        connection.exec_driver_sql("BEGIN")
    else:
        _begin_writing(connection)


def _begin_writing(connection: Connection) -> None:
    """Wait for the write lock as long as the engine says. Raises sqlalchemy.exc.OperationalError.

    SQLite itself soon looks every 100 ms only: beside a process whose threads write one after the other, that
    is to come too late again and again. At most one thread of a process waits here (Sessions).
    """
    driver = connection.connection.driver_connection
    assert isinstance(driver, sqlite3.Connection)  # noqa: S101 - _prepare_sqlite has looked
    timeout_s = busy_timeout_s_of(connection.get_execution_options())
    deadline_s = time.monotonic() + timeout_s
    driver.execute("PRAGMA busy_timeout = 0")
    try:
        while True:
            try:
                driver.execute("BEGIN IMMEDIATE")
            except sqlite3.Error as error:
                is_busy = error.sqlite_errorcode & 0xFF == sqlite3.SQLITE_BUSY
            else:
                return
            if not is_busy or time.monotonic() > deadline_s:
                connection.exec_driver_sql("BEGIN IMMEDIATE")  # raises it as the callers know it
                return
            time.sleep(LOOK_S)
    finally:
        driver.execute(f"PRAGMA busy_timeout = {round(timeout_s * 1000)}")
