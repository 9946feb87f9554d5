"""Fills a migrated database with ten years of rows, by statements that make them in the database itself."""

import sqlite3
from collections.abc import Iterable, Iterator

from sqlalchemy import Connection, Engine, text

from benchmarks.storage import condition_rows
from benchmarks.storage.bulk_rows import MOTORS, ROWS_A_STATEMENT, Bulk, bulks, insert
from benchmarks.storage.filling import Progress, without_indexes, without_sqlite_indexes
from benchmarks.storage.plant import plant_of
from service.storage import Repository, connect, migrate


def fill_ten_years(url: str, diagnoses: int, measurements: int, progress: Progress) -> None:
    """Make the tables in the database at this URL, and put a plant and ten years of it there."""
    migrate(url)
    engine = connect(url)
    _write_plant(engine)
    dialect = engine.dialect.name
    tables = tuple(bulks(dialect, diagnoses, measurements))
    if dialect == "postgresql":
        _fill_postgresql(engine, tables, progress)
    else:
        _fill_sqlite(engine, tables, progress)
    with engine.begin() as connection:
        _count(connection, diagnoses)
        condition_rows.judge_motors(connection)
    engine.dispose()


def _write_plant(engine: Engine) -> None:
    Repository(engine).sync_plant(plant_of(MOTORS))


def _statements(bulk: Bulk, dialect: str) -> Iterator[tuple[str, dict[str, object]]]:
    step = max(1, ROWS_A_STATEMENT * bulk.numbers // bulk.rows)
    for first in range(0, bulk.numbers, step):
        yield insert(bulk, dialect, first, min(bulk.numbers, first + step) - 1)


def _fill_sqlite(engine: Engine, tables: Iterable[Bulk], progress: Progress) -> None:
    file = engine.url.database
    assert file is not None
    engine.dispose()  # the mode of the journal changes only while nobody else has the file open
    connection = sqlite3.connect(file, isolation_level=None)
    with without_sqlite_indexes(connection, progress):
        for bulk in tables:
            connection.execute("BEGIN")
            for statement, parameters in _statements(bulk, "sqlite"):
                connection.execute(statement, parameters)
            connection.execute("COMMIT")
            progress(f"{bulk.table}: {bulk.rows:,} rows")
    connection.close()


def _fill_postgresql(engine: Engine, tables: Iterable[Bulk], progress: Progress) -> None:
    names = ", ".join(sorted({bulk.table for bulk in tables}))
    with engine.begin() as connection:
        # What is written to a table that the same transaction has emptied is not logged (wal_level=minimal).
        connection.execute(text(f"TRUNCATE {names} CASCADE"))
        with without_indexes(connection, progress):
            connection.execute(
                text("SET LOCAL session_replication_role = replica")
            )  # foreign keys hold anyway
            connection.execute(text("SET LOCAL maintenance_work_mem = '1GB'"))
            for bulk in tables:
                for statement, parameters in _statements(bulk, "postgresql"):
                    connection.execute(text(statement), parameters)
                progress(f"{bulk.table}: {bulk.rows:,} rows")
    with engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
        connection.execute(text("VACUUM ANALYZE"))
        progress("vacuumed")


def _count(connection: Connection, diagnoses: int) -> None:
    """Enter the numbers by state, which the repository keeps while it writes."""
    for table, state in (("recordings", "diagnosed"), ("jobs", "done")):
        connection.execute(
            text("UPDATE state_counts SET number = :number WHERE counted_table = :table AND state = :state"),
            {"number": diagnoses, "table": table, "state": state},
        )
