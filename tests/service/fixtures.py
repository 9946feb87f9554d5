"""A migrated SQLite file, a repository on it that knows the small plant, and a recording store."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy import Engine, func, select
from sqlalchemy.orm import Session

from service.configuration.settings import sqlite_url
from service.recording_store.folder import FolderStore
from service.storage import Repository, connect, migrate
from service.storage.models import (
    AlarmRow,
    JobRow,
    RecordingRequestRow,
    RecordingRow,
    StandingAlarmCountRow,
    StateCountRow,
)
from service.storage.transaction_limits import TransactionLimits
from testing.not_installed import not_installed
from testing.service.job_runner import register_runner
from testing.service.plants import two_motor_plant
from testing.service.postgresql import INSTALLED, PostgresServer, binaries, serving_postgresql


@pytest.fixture(scope="session")
def migrated_sqlite(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A migrated file to copy: migrating anew for each test would take longer than most tests."""
    url = sqlite_url(tmp_path_factory.mktemp("migrated"))
    migrate(url)
    path = Path(url.removeprefix("sqlite:///"))
    assert not path.with_name(f"{path.name}-wal").exists(), "all of it is in the one file"
    return path


@pytest.fixture
def database_url(request: pytest.FixtureRequest, tmp_path: Path, migrated_sqlite: Path) -> str:
    """A migrated database; tests may ask for "postgresql" as this fixture's parameter."""
    return _migrated(request, tmp_path, migrated_sqlite)


@pytest.fixture(params=["sqlite", "postgresql"])
def database_url_of_each(request: pytest.FixtureRequest, tmp_path: Path, migrated_sqlite: Path) -> str:
    """A migrated database on each of both, for rooms whose tests run on both."""
    return _migrated(request, tmp_path, migrated_sqlite)


def _migrated(request: pytest.FixtureRequest, tmp_path: Path, migrated_sqlite: Path) -> str:
    if getattr(request, "param", "sqlite") == "postgresql":
        url = request.getfixturevalue("postgresql_url")
        assert isinstance(url, str)
        return url
    url = sqlite_url(tmp_path)
    shutil.copy(migrated_sqlite, url.removeprefix("sqlite:///"))
    return url


@pytest.fixture(scope="session")
def postgresql() -> Iterator[PostgresServer]:
    """A server for the session. Where none is installed the test is skipped, and fails where CI=true."""
    folder = binaries()
    if folder is None:
        not_installed(f"no PostgreSQL server in {INSTALLED}: apt-get install postgresql")
    with serving_postgresql(folder) as server:
        yield server


@pytest.fixture
def postgresql_url(postgresql: PostgresServer) -> Iterator[str]:
    """A migrated database of its own on the server."""
    with postgresql.database() as url:
        yield url


PATIENT = TransactionLimits(idle_s=600.0, lock_wait_s=60.0)
"""A test's process may stand still on a busy machine; the limits have tests of their own."""


@pytest.fixture
def engine(database_url: str) -> Iterator[Engine]:
    engine = connect(database_url, limits=PATIENT)
    yield engine
    engine.dispose()


@pytest.fixture
def repository(engine: Engine) -> Repository:
    """A repository that knows the small plant and a job runner, `RUNNER`."""
    repository = Repository(engine)
    repository.sync_plant(two_motor_plant())
    register_runner(repository)
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


AlarmCounts = dict[tuple[str, str], int]


def standing_alarm_counts(engine: Engine) -> tuple[AlarmCounts, AlarmCounts]:
    """How many alarms of each kind stand at each relay: as the service keeps it, and counted."""
    with Session(engine) as session:
        kept = {
            (row.ied, str(row.kind)): row.number
            for row in session.scalars(select(StandingAlarmCountRow))
            if row.number
        }
        standing = select(AlarmRow.ied, AlarmRow.kind, func.count()).where(
            AlarmRow.cleared_ns.is_(None), AlarmRow.ied.is_not(None)
        )
        counted = {
            (str(ied), str(kind)): number
            for ied, kind, number in session.execute(standing.group_by(AlarmRow.ied, AlarmRow.kind))
        }
    return kept, counted


@pytest.fixture
def store(tmp_path: Path) -> FolderStore:
    return FolderStore(tmp_path / "recordings")
