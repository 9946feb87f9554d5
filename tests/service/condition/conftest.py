"""Every test of the conditions runs on both databases; on PostgreSQL in make test-all.

One of folding runs on PostgreSQL in every run, and what differs between the two, their statements and
transactions, tests/service/storage has in every run.
"""

import pytest

from tests.service.fixtures import database_url as sqlite_database_url
from tests.service.fixtures import engine, repository, store

__all__ = ["engine", "repository", "sqlite_database_url", "store"]


@pytest.fixture(params=["sqlite", pytest.param("postgresql", marks=pytest.mark.campaign)])
def database_url(request: pytest.FixtureRequest) -> str:
    url = request.getfixturevalue("sqlite_database_url" if request.param == "sqlite" else "postgresql_url")
    assert isinstance(url, str)
    return url
