"""A service on a port of the loopback that attackers and its users log in at."""

import time
from collections.abc import Callable, Iterator, MutableMapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import httpx
import pytest
import structlog

from service.access.passwords import hashed
from service.api import ApiContext
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.storage.records import Role
from service.web.app import create_site
from testing.service.accounts import TESTS
from tests.service.api.serving import LONGEST_S, serving
from tests.service.fixtures import database_url, engine, migrated_sqlite, repository, store

__all__ = ["database_url", "engine", "logs", "migrated_sqlite", "repository", "serve", "store"]

API = "/api/v1"
LOGIN = f"{API}/login"
PASSWORD = "correct horse battery"  # noqa: S105 - of nobody
HASH = hashed(PASSWORD)

Serve = Callable[..., httpx.Client]
"""Starts a service with these settings of [access]; returns a browser that has not logged in.

address: at which people reach it.
"""


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


def add_user(repository: Repository, name: str, *roles: Role) -> dict[str, str]:
    """Make a user with the password above; return what they log in with."""
    repository.add_user(name, roles, password=HASH, by=TESTS, now_ns=time.time_ns())
    return {"name": name, "password": PASSWORD}


def another(browser: httpx.Client) -> httpx.Client:
    """Return another browser at the same service, without cookies."""
    return httpx.Client(base_url=browser.base_url, trust_env=False, timeout=LONGEST_S)
