"""What happens to alarms by itself: shelvings end when their time has come, and so do suppressions.

Several services may do this on one database: each alarm is changed once.
"""

from threading import Event

from service.storage import Repository

PERIOD_S = 10.0


class AlarmSteps:
    """Ends shelvings and suppressions that are over."""

    def __init__(self, repository: Repository, stopping: Event | None = None) -> None:
        """stopping: set when the work should end, though there is more."""
        self._repository = repository
        self._stopping = stopping or Event()

    def take(self, now_ns: int) -> None:
        """End what is over at this time. Raises SQLAlchemyError."""
        for end in (self._repository.end_shelvings, self._repository.end_suppressions):
            while not self._stopping.is_set() and end(now_ns=now_ns):
                pass
