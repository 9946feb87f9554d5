"""What raises alarms is tested on both databases."""

from tests.service.storage.conftest import database_url, engine, repository, sqlite_database_url, store

__all__ = ["database_url", "engine", "repository", "sqlite_database_url", "store"]
