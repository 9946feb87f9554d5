"""What happens to alarms by itself: shelvings end when their time has come, suppressions begin and end.

Several services may do this on one database: each alarm is changed once.
"""

from threading import Event

from service.storage import Repository

PERIOD_S = 10.0


class AlarmSteps:
    """Ends shelvings that are over, and suppresses alarms as the plant's design says."""

    def __init__(self, repository: Repository, stopping: Event | None = None) -> None:
        """stopping: set when the work should end, though there is more."""
        self._repository = repository
        self._stopping = stopping or Event()

    def take(self, now_ns: int) -> None:
        """Do what is due at this time. Raises SQLAlchemyError."""
        steps = (
            self._repository.end_shelvings,
            self._repository.begin_suppressions,
            self._repository.end_suppressions,
        )
        for step in steps:
            while not self._stopping.is_set() and step(now_ns=now_ns):
                pass
