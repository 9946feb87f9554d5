"""A migrated SQLite file, a repository on it that knows the small plant, and a recording store."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy import Engine

from service.configuration.settings import sqlite_url
from service.recording_store.store import RecordingStore
from service.storage import Repository, connect, migrate
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


@pytest.fixture
def store(tmp_path: Path) -> RecordingStore:
    return RecordingStore(tmp_path / "recordings")
