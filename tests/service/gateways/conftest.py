"""A plant of two motors in a database that gateways read."""

from pathlib import Path

import pytest

from service.configuration.settings import sqlite_url
from service.storage import Repository, connect
from testing.service.database import make_database
from testing.service.plants import two_motor_plant


@pytest.fixture
def repository(tmp_path: Path) -> Repository:
    """Both motors are in it, and nothing is known of them yet."""
    assert make_database(tmp_path) == sqlite_url(tmp_path)
    repository = Repository(connect(sqlite_url(tmp_path)))
    repository.sync_plant(two_motor_plant())
    return repository
