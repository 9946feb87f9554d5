"""Stamps of topics, asked of the database only after something was written."""

import time
from collections.abc import Collection, Mapping
from threading import Lock

from core.units import NANOSECONDS_PER_SECOND
from service.storage.repository import Repository
from service.web.live.topics import Topic

REFRESH_S = 300
"""Pages are told at least so often: records get stale, and ages change, without anything being written."""


class Changes:
    """Safe to share between threads. A stamp holds until the database's counter of changes moves on."""

    def __init__(self, repository: Repository) -> None:
        self._repository = repository
        self._counter = repository.change_counter()
        self._lock = Lock()
        self._counted: object = None
        self._known: dict[Topic, str] = {}

    def stamps(self, topics: Collection[Topic]) -> Mapping[Topic, str]:
        """Return a stamp of each topic; it is another one when a page would show anything else.

        Raises SQLAlchemyError where the database does not answer.
        """
        period = time.time_ns() // (REFRESH_S * NANOSECONDS_PER_SECOND)
        with self._lock:
            counted = self._counter.value()
            if counted != self._counted:
                self._known.clear()
                self._counted = counted
            self._ask([topic for topic in topics if topic not in self._known])
            return {topic: f"{self._known[topic]}-{period:x}" for topic in topics}

    def close(self) -> None:
        """Give the counter's connection back."""
        with self._lock:
            self._counter.close()

    def _ask(self, topics: Collection[Topic]) -> None:
        subjects = {topic.subject: topic for topic in topics if topic.subject is not None}
        if subjects:
            found = self._repository.change_stamps(list(subjects))
            self._known.update((subjects[subject], stamp) for subject, stamp in found.items())
        motors = {topic.motor: topic for topic in topics if topic.motor is not None}
        if motors:
            named = self._repository.motor_stamps(list(motors))
            self._known.update((motors[motor], stamp) for motor, stamp in named.items())
