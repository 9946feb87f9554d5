"""Tells a database that does not answer from one that refuses what it is asked."""

import sqlite3

from sqlalchemy.exc import DBAPIError, InterfaceError, OperationalError, SQLAlchemyError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError


def does_not_answer(error: BaseException) -> bool:
    """Tell whether the same request may succeed later: the database is away, locked or out of room.

    SQLite calls a wrong statement operational too; that one is ours to mend.
    """
    if isinstance(error, DBAPIError) and error.connection_invalidated:
        return True
    if isinstance(error, OperationalError):
        return getattr(error.orig, "sqlite_errorcode", None) != sqlite3.SQLITE_ERROR
    return isinstance(error, InterfaceError | PoolTimeoutError)


def database_trouble(error: SQLAlchemyError) -> str:
    """Return what is wrong with the database, in words."""
    if does_not_answer(error):
        return f"the database does not answer: {error}"
    return f"the database refused a statement of this service ({type(error).__name__}): {error}"
