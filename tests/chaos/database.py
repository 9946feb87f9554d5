"""The database of a run, and what goes wrong with it: an SQLite file, or PostgreSQL behind a network."""

import signal
import sqlite3
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import Lock
from typing import Protocol

import sqlalchemy
from sqlalchemy import Connection
from sqlalchemy.exc import DBAPIError, OperationalError
from sqlalchemy.pool import NullPool

from scl import Address
from service.demo.addresses import free_ports
from testing.service.postgresql import INSTALLED, OPTIONS, OWNER, PostgresServer, binaries, serving_postgresql
from testing.tcp_proxy import Proxy
from tests.chaos.history import History
from tests.chaos.schedule import Action

LOCK_LIMIT_S = 30.0
TRY_AGAIN_S = 0.05
CUT_AFTER_BYTES = (20, 600, 9_000)
LINK = "database"
NAME = "mcc"

Faults = Mapping[str, Callable[[Action], None]]

TWICE = "SELECT recording_id, count(*) FROM diagnoses GROUP BY recording_id HAVING count(*) > 1"
"""Nobody asks for a second diagnosis in a run."""


class Database(Protocol):
    """settings: of a service that uses it.  faults: by the names of schedule.py."""

    settings: dict[str, str]
    faults: Faults

    def integrity(self) -> str:
        """What the database says of its own files: "ok"."""
        ...

    def diagnosed_twice(self) -> list[str]:
        """Recordings that have more than one diagnosis."""
        ...


class SqliteDatabase:
    """The service's own file."""

    def __init__(self, file: Path, history: History) -> None:
        self.settings: dict[str, str] = {}
        self._file = file
        self._history = history
        self.faults: Faults = {"database-locked": self._lock}

    def integrity(self) -> str:
        connection = sqlite3.connect(self._file)
        try:
            whole = [str(line[0]) for line in connection.execute("PRAGMA integrity_check")]
            orphans = [str(line) for line in connection.execute("PRAGMA foreign_key_check")]
        finally:
            connection.close()
        return "; ".join([*whole, *orphans])

    def diagnosed_twice(self) -> list[str]:
        connection = sqlite3.connect(self._file)
        try:
            return [f"{recording}: {number}" for recording, number in connection.execute(TWICE)]
        finally:
            connection.close()

    def _lock(self, action: Action) -> None:
        database = self._locked(time.monotonic() + LOCK_LIMIT_S)
        try:
            time.sleep(action.length_s)
            database.execute("ROLLBACK")
        finally:
            database.close()

    def _locked(self, until_s: float) -> sqlite3.Connection:
        """Tried again where it fails: while the disk is full too, nobody can lock anything."""
        while True:
            database = sqlite3.connect(self._file, timeout=LOCK_LIMIT_S, isolation_level=None)
            try:
                database.execute("BEGIN IMMEDIATE")
            except sqlite3.OperationalError as error:
                database.close()
                if time.monotonic() > until_s:
                    raise
                self._history.note(f"the database cannot be locked yet: {error}")
                time.sleep(TRY_AGAIN_S)
            else:
                return database


def integrity_of(connection: Connection) -> str:
    """Every index has all rows of its table in order, and every table's pages are sound (amcheck)."""
    connection.exec_driver_sql("CREATE EXTENSION IF NOT EXISTS amcheck")
    try:
        connection.exec_driver_sql(
            "SELECT bt_index_check(i.indexrelid, true) FROM pg_index i JOIN pg_class c "
            "ON c.oid = i.indexrelid JOIN pg_am a ON a.oid = c.relam "
            # Not those of partitioned tables: their partitions have indexes of their own.
            "WHERE a.amname = 'btree' AND c.relkind = 'i' AND c.relpersistence = 'p'"
        )
        found = connection.exec_driver_sql(
            "SELECT c.relname, v.msg FROM pg_class c, verify_heapam(c.oid) v "
            "WHERE c.relkind = 'r' AND c.relpersistence = 'p'"
        ).all()
    except DBAPIError as error:
        return str(error.orig)
    return "; ".join(f"{table}: {message}" for table, message in found) or "ok"


class PostgresqlDatabase:
    """A server of this run's own, which the service reaches through a network that can be cut."""

    def __init__(self, server: PostgresServer, proxy: Proxy) -> None:
        self._server = server
        self._proxy = proxy
        self._restarting = Lock()
        seen = proxy.links[LINK].seen
        self.settings = {"MCC_DATABASE_URL": f"postgresql+psycopg://{OWNER}@{seen.host}:{seen.port}/{NAME}"}
        self.faults: Faults = {
            "database-locked": self._lock,
            "database-restarted": lambda action: self._restart(signal.SIGINT, action),
            "database-crashed": lambda action: self._restart(signal.SIGQUIT, action),
            "database-connections-ended": self._end_connections,
            "database-link-cut": lambda action: proxy.cut_after(
                LINK, CUT_AFTER_BYTES[action.number % len(CUT_AFTER_BYTES)]
            ),
            "database-link-frozen": self._freeze_link,
        }

    def integrity(self) -> str:
        """What amcheck says of indexes and pages."""
        with self._connection() as connection:
            return integrity_of(connection)

    def diagnosed_twice(self) -> list[str]:
        with self._connection() as connection:
            return [f"{recording}: {number}" for recording, number in connection.exec_driver_sql(TWICE).all()]

    def _lock(self, action: Action) -> None:
        """As by a person who has forgotten a transaction."""
        with suppress(OperationalError), self._connection() as connection:  # the server may end meanwhile
            connection.exec_driver_sql("BEGIN")
            connection.exec_driver_sql("LOCK TABLE recordings IN ACCESS EXCLUSIVE MODE")
            time.sleep(action.length_s)
            connection.exec_driver_sql("ROLLBACK")

    def _restart(self, end: signal.Signals, action: Action) -> None:
        with self._restarting:
            self._server.stop(end)
            time.sleep(action.length_s)
            self._server.start()

    def _end_connections(self, _action: Action) -> None:
        with suppress(OperationalError), self._connection() as connection:
            connection.exec_driver_sql(
                "SELECT pg_terminate_backend(pid) FROM pg_stat_activity "
                "WHERE datname = current_database() AND pid <> pg_backend_pid()"
            )

    def _freeze_link(self, action: Action) -> None:
        self._proxy.freeze(LINK, on=True)
        try:
            time.sleep(action.length_s)
        finally:
            self._proxy.freeze(LINK, on=False)

    @contextmanager
    def _connection(self) -> Iterator[sqlalchemy.Connection]:
        """A connection beside the network that is cut."""
        engine = sqlalchemy.create_engine(
            self._server.url(NAME), isolation_level="AUTOCOMMIT", poolclass=NullPool
        )
        with engine.connect() as connection:
            yield connection


@contextmanager
def serving_database(kind: str, data: Path, history: History) -> Iterator[Database]:
    """The database of a service with this data directory. Raises RuntimeError where there is no server."""
    if kind == "sqlite":
        yield SqliteDatabase(data / "statorwatch.sqlite", history)
        return
    programs = binaries()
    if programs is None:
        raise RuntimeError(f"no PostgreSQL server in {INSTALLED}: apt-get install postgresql")
    own, seen = (Address("127.0.0.1", port) for port in free_ports(2))
    # What is committed must outlive a crash of the server; a power cut is not among the faults.
    options = OPTIONS | {
        "listen_addresses": own.host,
        "port": str(own.port),
        "synchronous_commit": "on",
        "full_page_writes": "on",
    }
    with serving_postgresql(programs, options) as server, Proxy({LINK: (own, seen)}) as proxy:
        server.execute(f"CREATE DATABASE {NAME}")
        yield PostgresqlDatabase(server, proxy)
