"""Waiting until jobs are queued, where the database tells of it: PostgreSQL does, by LISTEN and NOTIFY."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import sqlalchemy.exc

from service.storage.repository.counting_session import JOBS_QUEUED
from service.storage.repository.sessions import Sessions


class JobNoticeRows(Sessions):
    @property
    def tells_of_jobs(self) -> bool:
        """Return whether the database tells when jobs are queued."""
        return self._reading.dialect.name == "postgresql"

    @contextmanager
    def job_notices(self) -> Iterator[Callable[[float], bool]]:
        """Hold a connection of its own, and provide what waits on it: at most so many seconds.

        It returns whether jobs were queued since it was called before, by whomever. Raises SQLAlchemyError
        where the connection is lost: what is queued until the next one is not told.
        """
        import psycopg

        engine = self._reading.execution_options(isolation_level="AUTOCOMMIT")
        with engine.connect() as connection:
            driver = connection.connection.driver_connection
            assert isinstance(driver, psycopg.Connection)  # noqa: S101 - `connect` knows no other driver
            connection.detach()  # the pool is for short transactions
            connection.exec_driver_sql(f"LISTEN {JOBS_QUEUED}")

            def wait(timeout_s: float) -> bool:
                try:
                    return any(True for _ in driver.notifies(timeout=timeout_s, stop_after=1))
                except psycopg.Error as error:
                    raise sqlalchemy.exc.OperationalError(
                        f"LISTEN {JOBS_QUEUED}", None, error, connection_invalidated=True
                    ) from error

            yield wait
