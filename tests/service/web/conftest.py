from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from service.api import ApiContext
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.storage import Repository
from service.web.app import create_site
from tests.service.api.serving import serving
from tests.service.fixtures import database_url, engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]


@pytest.fixture
def context(repository: Repository, store: RecordingStore, tmp_path: Path) -> ApiContext:
    return ApiContext(Settings(data_directory=tmp_path), repository, store)


@pytest.fixture
def anybody(context: ApiContext) -> Iterator[httpx.Client]:
    """A browser of somebody who has not logged in."""
    with serving(create_site(context), as_somebody=False) as client:
        client.headers["Accept"] = "text/html,application/xhtml+xml,*/*;q=0.8"
        yield client


@pytest.fixture
def client(context: ApiContext) -> Iterator[httpx.Client]:
    """A browser of somebody who may do everything."""
    with serving(create_site(context)) as client:
        client.headers["Accept"] = "text/html,application/xhtml+xml,*/*;q=0.8"
        yield client
