"""The database's own counter of changes: one cheap question tells whether anything was written since."""

from contextlib import suppress

from sqlalchemy import Connection, Engine
from sqlalchemy.exc import SQLAlchemyError

STATEMENTS = {
    "sqlite": "PRAGMA data_version",
    # A transaction that writes takes a number, which the next snapshot shows as begun, and later as over.
    "postgresql": "SELECT txid_current_snapshot()",
}


class ChangeCounter:
    """Asks one connection that is kept for it. Not safe to share between threads without a lock."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._statement = STATEMENTS[engine.dialect.name]
        self._connection: Connection | None = None
        self._connections = 0

    def value(self) -> object:
        """Return a value that is another one after each change of what others see of the database.

        It may be another one without a change, too. Raises SQLAlchemyError where the database does not
        answer; a later call tries again.
        """
        if self._connection is None:
            self._connection = self._engine.connect()
            self._connections += 1
        try:
            counted = self._connection.exec_driver_sql(self._statement).scalar()
            self._connection.rollback()
        except SQLAlchemyError:
            self.close()
            raise
        return self._connections, counted

    def close(self) -> None:
        """Give the connection back; harmless without one."""
        connection, self._connection = self._connection, None
        if connection is not None:
            with suppress(SQLAlchemyError):  # the database may be gone
                connection.close()
