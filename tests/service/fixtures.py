"""A migrated SQLite file, a repository on it that knows the small plant, and a recording store."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy import Engine, func, select
from sqlalchemy.orm import Session

from service.configuration.settings import sqlite_url
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect, migrate
from service.storage.models import JobRow, RecordingRequestRow, RecordingRow, StateCountRow
from testing.service.plants import two_motor_plant


@pytest.fixture
def database_url(tmp_path: Path) -> str:
    url = sqlite_url(tmp_path)
    migrate(url)
    return url


@pytest.fixture
def engine(database_url: str) -> Iterator[Engine]:
    engine = connect(database_url)
    yield engine
    engine.dispose()


@pytest.fixture
def repository(engine: Engine) -> Repository:
    repository = Repository(engine)
    repository.sync_plant(two_motor_plant())
    return repository


def state_counts(engine: Engine) -> tuple[dict[tuple[str, str], int], dict[tuple[str, str], int]]:
    """How many rows there are in each state: as the service keeps it, and counted."""
    with Session(engine) as session:
        kept = {(row.counted_table, row.state): row.number for row in session.scalars(select(StateCountRow))}
        counted = dict.fromkeys(kept, 0) | {
            (table.__tablename__, str(state)): number
            for table in (RecordingRow, RecordingRequestRow, JobRow)
            for state, number in session.execute(select(table.state, func.count()).group_by(table.state))
        }
    return kept, counted


@pytest.fixture
def store(tmp_path: Path) -> RecordingStore:
    return RecordingStore(tmp_path / "recordings")
