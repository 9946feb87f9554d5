"""The server that most tests look at."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from service.configuration.settings import Settings
from service.storage import Repository
from testing.service.gateways import running_gateways
from tests.service.gateways.settings import settings_of


@pytest.fixture
def settings(repository: Repository, tmp_path: Path) -> Iterator[Settings]:
    """Of a server at which anybody may look, without encryption."""
    chosen = settings_of("opcua", tmp_path, anonymous=True, unencrypted=True)
    with running_gateways(chosen):
        yield chosen
