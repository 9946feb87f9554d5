"""A service's data on either database, with recordings, and the back-ups that are made of it."""

import uuid
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import pytest
from sqlalchemy import Engine, MetaData, select

from service.backup.making import MadeBackup, Source
from service.backup.noted import make_noted_backup
from service.backup.restoring import Place
from service.configuration.settings import sqlite_url
from service.recording_store.folder import FolderStore
from service.storage import Repository, connect
from testing.service.findings import findings_of
from testing.service.job_runner import RUNNER
from testing.service.plants import NOW_NS, SECOND_NS, fault
from testing.service.postgresql import PostgresServer
from tests.service.storage.conftest import (
    database_url,
    engine,
    repository,
    store,
    the_state_counts_are_right,
)

__all__ = [
    "database_url",
    "engine",
    "repository",
    "store",
    "the_state_counts_are_right",
]

Rows = dict[str, list[tuple[object, ...]]]


@dataclass(frozen=True)
class Data:
    """A service's data, and the directory of its back-ups."""

    url: str
    engine: Engine
    repository: Repository
    store: FolderStore
    directory: Path

    @property
    def source(self) -> Source:
        return Source(self.url, self.store.root, {})

    def record(self, text: str, *, motor: str = "PUMP-A1") -> str:
        """A recording with its diagnosis."""
        stored = self.store.store({f"{text}.CFG": text.encode(), f"{text}.DAT": text.encode() * 1000})
        added = self.repository.add_recording(stored, motor=motor, now_ns=NOW_NS).recording
        claimed = self.repository.claim_job(now_ns=2**62, runner=RUNNER)
        assert claimed is not None
        self.repository.finish_job(
            claimed.job.id, findings_of(fault()), recorded_ns=NOW_NS, now_ns=NOW_NS + SECOND_NS, runner=RUNNER
        )
        return added.id

    def back_up(self, **options: object) -> MadeBackup:
        made = make_noted_backup(self.repository, self.source, self.directory, **options)  # type: ignore[arg-type]  # each test has options of its own
        assert made is not None
        return made

    def rows(self) -> Rows:
        return rows_of(self.engine)


def rows_of(engine: Engine) -> Rows:
    """All rows of all tables but that of the back-ups, which goes on while one is made."""
    metadata = MetaData()
    with engine.connect() as connection:
        metadata.reflect(connection)
        return {
            table.name: sorted((tuple(row) for row in connection.execute(select(table))), key=repr)
            for table in metadata.sorted_tables
            if table.name != "backups"
        }


@pytest.fixture
def data(
    repository: Repository, engine: Engine, database_url: str, store: FolderStore, tmp_path: Path
) -> Data:
    return Data(database_url, engine, repository, store, tmp_path / "copies")


@pytest.fixture
def empty_place(database_url: str, request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Place]:
    """Somewhere else with nothing in it, for a database of the same kind."""
    with ExitStack() as opened:
        elsewhere = tmp_path / "elsewhere"
        url = sqlite_url(elsewhere)
        if database_url.startswith("postgresql"):
            server = request.getfixturevalue("postgresql")
            assert isinstance(server, PostgresServer)
            url = opened.enter_context(server.database(migrated=False))
        yield Place(elsewhere, url, elsewhere / "recordings")


@pytest.fixture
def look() -> Callable[[str], Rows]:
    """What is in a database, asked by a connection that is gone afterwards."""

    def rows(url: str) -> Rows:
        engine = connect(url)
        try:
            return rows_of(engine)
        finally:
            engine.dispose()

    return rows


def files_below(root: Path) -> dict[str, bytes]:
    """All files of a store by their paths."""
    return {
        path.relative_to(root).as_posix(): path.read_bytes() for path in root.glob("??/*/*") if path.is_file()
    }


def new_name() -> str:
    return f"R{uuid.uuid4().hex[:12].upper()}"
