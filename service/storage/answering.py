"""A database that cannot be reached, or not be written to, in words for the person who starts a command."""

from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy.exc import OperationalError

from service.storage.database_url import readable_url
from service.storage.errors import StorageError


class DatabaseUnusableError(StorageError):
    """The database does not answer, or refuses what a start needs of it."""


@contextmanager
def answering(database_url: str) -> Iterator[None]:
    """Raise DatabaseUnusableError where the database does not do what the block asks of it."""
    try:
        yield
    except OperationalError as error:
        raise DatabaseUnusableError(
            f"{readable_url(database_url)}: expected a database that can be read and written "
            f"(setting database_url), found: {error.orig}; is its disk full, or its server down?"
        ) from error
