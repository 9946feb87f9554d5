"""A service on a port of the loopback, its database and its store, for every attack that wants one."""

import time
from collections.abc import Iterator, MutableMapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import httpx
import pytest
import structlog

from service.api import ApiContext
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.web.app import create_site
from tests.attacks.login_service import Clock, Serve
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, migrated_sqlite, repository, store

__all__ = ["database_url", "engine", "migrated_sqlite", "repository", "store"]


@pytest.fixture(autouse=True)
def logs() -> Iterator[list[MutableMapping[str, Any]]]:
    """What the service logs, kept from the screen: tracebacks for people take seconds to draw."""
    with structlog.testing.capture_logs() as entries:
        yield entries


@pytest.fixture
def serve(repository: Repository, store: RecordingStore, tmp_path: Path) -> Iterator[Serve]:
    with ExitStack() as services:

        def started(address: str | None = None, **access: object) -> httpx.Client:
            given = {"data_directory": tmp_path, "access": access, "notifications": {"address": address}}
            settings = Settings.model_validate(given)
            site = create_site(ApiContext(settings, repository, store))
            return services.enter_context(serving(site, as_somebody=False))

        yield started


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Iterator[Clock]:
    """Set the time of the service and of authenticator apps."""
    clock = Clock()
    monkeypatch.setattr(time, "time_ns", lambda: clock.now_ns)
    yield clock
    monkeypatch.undo()  # before the service ends
