"""The partitions of the measured values: made before their rows come, dropped when all of them are old."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from sqlalchemy import Connection
from sqlalchemy.exc import OperationalError

from service.storage import partitions
from service.storage.engine import one_at_a_time
from service.storage.partitions import Period
from service.storage.repository.sessions import Sessions

WORK = "partitions of measurements"
"""What one transaction does at a time."""

_IN_USE = "55P03"
"""What PostgreSQL calls it where a lock is not to be had in time."""


class MeasurementPartitionRows(Sessions):
    def make_measurement_partitions(self, *, now_ns: int) -> Sequence[str]:
        """Make the partitions of the time under way and of the next, and of what waits for one.

        Return the names of the new ones; none on SQLite, and where others used the table all the time.
        """

        def make(connection: Connection) -> Sequence[Period]:
            return partitions.make(connection, {*partitions.wanted(now_ns), *partitions.waiting(connection)})

        return tuple(period.name for period in self._changed(make))

    def drop_measurement_partitions(self, step_s: int, *, before_ns: int) -> Sequence[str]:
        """Drop the partitions of a step that have nothing later than a time; return their names.

        None on SQLite, and where others used the table all the time: the next round does it.
        """
        drop = partial(partitions.drop, step_s=step_s, before_ns=before_ns)
        return tuple(period.name for period in self._changed(drop))

    def _changed(self, change: Callable[[Connection], Sequence[Period]]) -> Sequence[Period]:
        if self._reading.dialect.name != "postgresql":
            return ()
        try:
            with self._write() as session:
                connection = session.connection()
                one_at_a_time(connection, WORK)
                return change(connection)
        except OperationalError as error:
            if _code(error.orig) != _IN_USE:
                raise
            return ()


def _code(error: Any) -> str | None:
    return getattr(error, "sqlstate", None)
