"""What raises alarms is tested on both databases."""

from tests.service.storage.conftest import database_url, engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]
