"""Fills a migrated database as fast as it takes rows: indexes are made last, nothing waits for the disk."""

import sqlite3
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

from sqlalchemy import Connection, Engine, text

from benchmarks.storage import condition_rows, rows, upkeep_rows
from benchmarks.storage.plant import plant_of
from benchmarks.storage.rows import Amounts, Table
from service.storage import Repository, connect, migrate

COUNTED = ("recordings", "recording_requests", "jobs")

Progress = Callable[[str], None]


def fill(url: str, amounts: Amounts, progress: Progress = lambda _line: None) -> None:
    """Migrate the database at this URL, and put a plant and so many rows into it."""
    migrate(url)
    engine = connect(url)
    Repository(engine).sync_plant(plant_of(amounts.motors))
    load(engine, _tables(amounts), progress)
    with engine.begin() as connection:
        _count(connection)
        condition_rows.judge(connection)
        upkeep_rows.end_trail(connection, amounts)
    engine.dispose()


def load(engine: Engine, tables: Iterable[Table], progress: Progress) -> None:
    """Put the rows of tables into an empty database."""
    put = _load_postgresql if engine.dialect.name == "postgresql" else _load_sqlite
    put(engine, tables, progress)


def _tables(amounts: Amounts) -> Iterator[Table]:
    yield from rows.tables(amounts)
    yield from condition_rows.tables(amounts)
    yield from upkeep_rows.tables(amounts)


def _load_sqlite(engine: Engine, tables: Iterable[Table], progress: Progress) -> None:
    file = engine.url.database
    assert file is not None
    engine.dispose()  # the mode of the journal changes only while nobody else has the file open
    connection = sqlite3.connect(file, isolation_level=None)
    with without_sqlite_indexes(connection, progress):
        for table in tables:
            places = ", ".join("?" * len(table.columns))
            columns = ", ".join(f'"{column}"' for column in table.columns)
            insert = f"INSERT INTO {table.name} ({columns}) VALUES ({places})"  # noqa: S608 - our names
            connection.execute("BEGIN")
            written = connection.executemany(insert, table.rows).rowcount
            connection.execute("COMMIT")
            progress(f"{table.name}: {written:,} rows")
    connection.close()


@contextmanager
def without_sqlite_indexes(connection: sqlite3.Connection, progress: Progress) -> Iterator[None]:
    """Write without a journal and without indexes that are no constraints, and make them afterwards."""
    for pragma in ("journal_mode=OFF", "synchronous=OFF", "cache_size=-2000000", "foreign_keys=OFF"):
        connection.execute(f"PRAGMA {pragma}")
    kept = "SELECT name, sql FROM sqlite_master WHERE type = 'index' AND sql IS NOT NULL"
    indexes = connection.execute(kept).fetchall()
    for name, _statement in indexes:
        connection.execute(f"DROP INDEX {name}")
    yield
    for name, statement in indexes:
        connection.execute(statement)
        progress(f"index {name}")
    connection.execute("PRAGMA journal_mode=WAL")


def _load_postgresql(engine: Engine, tables: Iterable[Table], progress: Progress) -> None:
    with engine.begin() as connection, without_indexes(connection, progress):
        connection.execute(text("SET LOCAL session_replication_role = replica"))  # foreign keys hold anyway
        connection.execute(text("SET LOCAL maintenance_work_mem = '1GB'"))
        for table in tables:
            progress(f"{table.name}: {_copy(connection, table):,} rows")
    with engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
        connection.execute(text("VACUUM ANALYZE"))


def _copy(connection: Connection, table: Table) -> int:
    driver = connection.connection.driver_connection
    assert driver is not None
    written = 0
    columns = ", ".join(f'"{column}"' for column in table.columns)
    statement = f"COPY {table.name} ({columns}) FROM STDIN"
    with driver.cursor() as cursor, cursor.copy(statement) as copy:
        for row in table.rows:
            copy.write_row(row)
            written += 1
    return written


@contextmanager
def without_indexes(connection: Connection, progress: Progress) -> Iterator[None]:
    """Drop the indexes that are no constraints, and make them again; those of partitions follow."""
    query = text(
        "SELECT indexname, replace(indexdef, ' ON ONLY ', ' ON ') FROM pg_indexes WHERE schemaname = 'public'"
        " AND indexname NOT IN (SELECT conname FROM pg_constraint)"
        " AND indexname NOT IN (SELECT relname FROM pg_class WHERE relispartition)"
    )
    indexes = connection.execute(query).all()
    for name, _statement in indexes:
        connection.execute(text(f"DROP INDEX {name}"))
    yield
    for name, statement in indexes:
        connection.execute(text(statement))
        progress(f"index {name}")


def _count(connection: Connection) -> None:
    """Enter the numbers by state, which the repository keeps while it writes."""
    for table in COUNTED:
        count = f"SELECT count(*) FROM {table} WHERE {table}.state = state_counts.state"  # noqa: S608 - our names
        connection.execute(
            text(f"UPDATE state_counts SET number = ({count}) WHERE counted_table = :table"),  # noqa: S608
            {"table": table},
        )
    standing = "SELECT ied, kind, count(*) FROM alarms WHERE cleared_ns IS NULL GROUP BY ied, kind"
    connection.execute(text(f"INSERT INTO standing_alarm_counts {standing}"))
