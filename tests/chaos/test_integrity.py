"""The check of a PostgreSQL database, beside one that is sound and one that is not."""

import sqlalchemy

from testing.service.postgresql import PostgresServer
from tests.chaos.database import integrity_of
from tests.service.fixtures import postgresql

__all__ = ["postgresql"]


def test_a_database_of_the_service_is_sound(postgresql: PostgresServer) -> None:
    """Its measured values are in partitions, whose common index has no pages."""
    with postgresql.database() as url:
        engine = sqlalchemy.create_engine(url)
        with engine.connect() as connection:
            assert integrity_of(connection) == "ok"
        engine.dispose()


def test_a_row_that_an_index_lacks_is_told(postgresql: PostgresServer) -> None:
    ready = "UPDATE pg_index SET indisready = {} WHERE indexrelid = 'kept_pkey'::regclass"
    with postgresql.database() as url:
        engine = sqlalchemy.create_engine(url, isolation_level="AUTOCOMMIT")
        with engine.connect() as connection:
            for statement in (
                "CREATE TABLE kept (number integer PRIMARY KEY)",
                ready.format("false"),
                "INSERT INTO kept VALUES (1)",
                ready.format("true"),
            ):
                connection.exec_driver_sql(statement)
            assert "lacks matching index tuple" in integrity_of(connection)
        engine.dispose()
