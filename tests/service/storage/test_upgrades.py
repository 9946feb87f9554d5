"""Each migration, up from each schema there was, with rows in every table: none is lost.

The rows are made from the tables as they are found. They are written at one revision after the other while
the database goes up, so that what was written at the first one has been through all migrations.
"""

from collections.abc import Iterator, Mapping, Sequence

import pytest
from alembic.script import ScriptDirectory
from sqlalchemy import Engine, text

from service.storage import connect, migrate
from service.storage.migrations import config
from testing.service.filled_tables import Filled, fill_tables, lost
from testing.service.tables import differences

_SCATTER = "0019: what was called the 95 % interval of the level was its scatter, and has that name"
MEANT: Mapping[str, str] = {
    "diagnoses.document": _SCATTER,
    "diagnoses.mu_f_ci95_low": _SCATTER,
    "diagnoses.mu_f_ci95_high": _SCATTER,
    "api_tokens": "0055: tokens of before end, because nothing tells who asked for them",
}
"""What a migration changes on purpose, and why; `test_migrations` looks at what it becomes."""


@pytest.fixture
def empty_url(database_url: str) -> str:
    """A database without any table."""
    engine = connect(database_url)
    with engine.begin() as connection:
        if engine.dialect.name == "postgresql":
            connection.execute(text("DROP SCHEMA public CASCADE"))
            connection.execute(text("CREATE SCHEMA public"))
    engine.dispose()
    if engine.dialect.name == "sqlite":
        return f"{database_url}.empty"
    return database_url


@pytest.fixture
def empty(empty_url: str) -> Iterator[Engine]:
    engine = connect(empty_url)
    yield engine
    engine.dispose()


def revisions(engine: Engine) -> Sequence[str]:
    """All revisions, oldest first."""
    with engine.connect() as connection:
        script = ScriptDirectory.from_config(config(connection))
    return [one.revision for one in script.walk_revisions()][::-1]


def up(engine: Engine, filled_at: Sequence[str]) -> Sequence[Filled]:
    """Bring an empty database up to the newest revision, with a row in every table at each of these."""
    written: list[Filled] = []
    url = engine.url.render_as_string(hide_password=False)
    for number, revision in enumerate(filled_at, start=1):
        migrate(url, revision)
        with engine.begin() as connection:
            written += fill_tables(connection, number)
    migrate(url)
    return written


def require_all(engine: Engine, written: Sequence[Filled]) -> None:
    with engine.connect() as connection:
        missing = [one for one in lost(connection, written) if one.partition(":")[0] not in MEANT]
        assert missing == []
        assert differences(connection) == []


def test_rows_of_earlier_revisions_go_up_to_the_newest(empty: Engine) -> None:
    require_all(empty, up(empty, revisions(empty)[:-1:8]))


@pytest.mark.campaign
@pytest.mark.timeout(600)
def test_rows_of_every_revision_go_up_to_the_newest(empty: Engine) -> None:
    require_all(empty, up(empty, revisions(empty)[:-1]))
