"""Every test of the API runs on both databases, unless it says that it is about one of them."""

from collections.abc import Iterator, MutableMapping
from pathlib import Path
from typing import Any

import httpx
import pytest
import structlog

from service.api import ApiContext, create_app
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from tests.service.api.serving import serving
from tests.service.fixtures import database_url_of_each as database_url
from tests.service.fixtures import engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]


@pytest.fixture(autouse=True)
def logs() -> Iterator[list[MutableMapping[str, Any]]]:
    """What the service logs, kept from the screen: tracebacks for people take seconds to draw."""
    with structlog.testing.capture_logs() as entries:
        yield entries


@pytest.fixture
def context(repository: Repository, store: RecordingStore, tmp_path: Path) -> ApiContext:
    settings = Settings(data_directory=tmp_path, max_upload_bytes=200_000)
    return ApiContext(settings, repository, store)


@pytest.fixture
def client(context: ApiContext) -> Iterator[httpx.Client]:
    with serving(create_app(context)) as client:
        yield client
