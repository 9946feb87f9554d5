from tests.service.storage.conftest import (
    database_url,
    engine,
    repository,
    store,
    the_state_counts_are_right,
)

__all__ = [
    "database_url",
    "engine",
    "repository",
    "store",
    "the_state_counts_are_right",
]
