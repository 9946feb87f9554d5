from pathlib import Path

import pytest
from sqlalchemy import Engine, inspect, text

from service.storage import Repository, StorageError, connect, migrate
from service.storage.states import JobState, RecordingRequestState, RecordingState
from testing.service.tables import differences

ON_SQLITE = pytest.mark.parametrize("database_url", ["sqlite"], indirect=True)


def test_the_migration_makes_the_tables_of_the_models(engine: Engine) -> None:
    with engine.connect() as connection:
        assert differences(connection) == []


def test_rows_that_are_there_from_the_start(engine: Engine, repository: Repository) -> None:
    with engine.connect() as connection:
        counted = connection.execute(text("SELECT counted_table, state, number FROM state_counts")).all()
        head = connection.execute(text("SELECT id, number, hash FROM audit_head")).all()
        forwarded = connection.execute(text("SELECT id, number FROM audit_forwarding")).all()
    states = {"recordings": RecordingState, "recording_requests": RecordingRequestState, "jobs": JobState}
    assert {tuple(row) for row in counted} == {
        (table, state.value, 0) for table, each in states.items() for state in each
    }
    assert [tuple(row) for row in head] == [(1, 0, "0" * 64)]
    assert [tuple(row) for row in forwarded] == [(1, 0)]
    assert repository.counts().jobs == {}


def test_migrating_again_changes_nothing(database_url: str, engine: Engine) -> None:
    revision = text("SELECT version_num FROM alembic_version")
    with engine.connect() as connection:
        before = connection.scalar(revision)
    migrate(database_url)
    with engine.connect() as connection:
        assert connection.scalar(revision) == before
        assert differences(connection) == []


@pytest.mark.parametrize("revision", ["0058", "0001_0123456789ab", "9999"])
def test_a_database_of_another_version_is_left_alone(
    database_url: str, engine: Engine, revision: str
) -> None:
    with engine.begin() as connection:
        connection.execute(text("UPDATE alembic_version SET version_num = :revision"), {"revision": revision})
        connection.execute(text("DROP TABLE record_figures"))
    expected = rf"revision 0001_\w+, found {revision}: another version made them; start that one to export"
    with pytest.raises(StorageError, match=expected):
        migrate(database_url)
    with engine.connect() as connection:
        assert connection.scalar(text("SELECT version_num FROM alembic_version")) == revision
    assert "record_figures" not in inspect(engine).get_table_names()


@ON_SQLITE
def test_sqlite_is_shared_safely(engine: Engine) -> None:
    with engine.connect() as connection:
        pragmas = {
            name: connection.scalar(text(f"PRAGMA {name}"))
            for name in ("journal_mode", "synchronous", "foreign_keys", "busy_timeout")
        }
    assert pragmas == {"journal_mode": "wal", "synchronous": 2, "foreign_keys": 1, "busy_timeout": 30_000}


@pytest.mark.parametrize("url", ["not a url", "sqlite://", "sqlite:///:memory:"])
def test_a_url_that_cannot_be_shared_is_refused(url: str) -> None:
    with pytest.raises(StorageError, match="database_url"):
        connect(url)


def test_a_path_with_a_percent_sign(tmp_path: Path) -> None:
    migrate(f"sqlite:///{tmp_path / '100%.sqlite'}")
    assert (tmp_path / "100%.sqlite").is_file()
