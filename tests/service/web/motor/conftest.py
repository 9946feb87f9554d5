"""A plant whose motor has a developing fault, made once for all tests that only look."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from service.api import ApiContext
from service.configuration.settings import Settings, sqlite_url
from service.recording_store.folder import FolderStore
from service.storage import Repository, connect
from service.web.app import create_site
from testing.service.database import make_database
from testing.service.job_runner import register_runner
from testing.service.plants import two_motor_plant
from tests.service.api.serving import serving
from tests.service.web.motor.recorded import Shown, record


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Shown]:
    data: Path = tmp_path_factory.mktemp("shown")
    make_database(data)
    engine = connect(sqlite_url(data))
    repository, store = Repository(engine), FolderStore(data / "recordings")
    repository.sync_plant(two_motor_plant())
    register_runner(repository)
    records = record(repository, store)
    with serving(create_site(ApiContext(Settings(data_directory=data), repository, store))) as client:
        client.headers["Accept"] = "text/html,application/xhtml+xml,*/*;q=0.8"
        yield Shown(client, repository, records)
    engine.dispose()
