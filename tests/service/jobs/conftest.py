"""Every test of the jobs runs on both databases, unless it says that it is about one of them."""

from tests.service.fixtures import database_url_of_each as database_url
from tests.service.fixtures import engine, repository, store

__all__ = ["database_url", "engine", "repository", "store"]
