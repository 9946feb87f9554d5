"""PostgreSQL databases that are not in UTF8."""

import pytest

from service.storage import Repository, StorageError, connect, migrate
from service.storage.records import Actor, Role
from testing.service.postgresql import PostgresServer

NAME = "Zoë Müller 電"
BY = Actor("test", "command line")


def test_a_database_without_an_encoding_keeps_every_text(postgresql: PostgresServer) -> None:
    with postgresql.database(migrated=False, encoding="SQL_ASCII") as url:
        migrate(url)
        engine = connect(url)
        repository = Repository(engine)
        repository.add_user(NAME, (Role.VIEWER,), password=None, by=BY, now_ns=1)
        assert [user.name for user in repository.users(limit=10).items] == [NAME]
        engine.dispose()


def test_a_database_that_lacks_characters_is_refused_before_anything_is_made(
    postgresql: PostgresServer,
) -> None:
    with postgresql.database(migrated=False, encoding="LATIN1") as url:
        with pytest.raises(
            StorageError, match="expected a database in UTF8, found LATIN1: make one with createdb"
        ):
            migrate(url)
        engine = connect(url)
        with engine.connect() as connection:
            assert (
                connection.exec_driver_sql(
                    "SELECT count(*) FROM pg_tables WHERE schemaname = 'public'"
                ).scalar()
                == 0
            )
        engine.dispose()
