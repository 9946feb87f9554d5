"""Every test of the conditions runs on both databases, unless it says that it is about one of them."""

import pytest

from tests.service.fixtures import database_url as sqlite_database_url
from tests.service.fixtures import engine, repository, store

__all__ = ["engine", "repository", "sqlite_database_url", "store"]


@pytest.fixture(params=["sqlite", "postgresql"])
def database_url(request: pytest.FixtureRequest) -> str:
    url = request.getfixturevalue("sqlite_database_url" if request.param == "sqlite" else "postgresql_url")
    assert isinstance(url, str)
    return url
