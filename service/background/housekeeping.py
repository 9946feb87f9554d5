"""Averages measured values while they are fresh, and deletes them when they are old."""

from threading import Event

import structlog

from service.configuration.settings import Settings
from service.retention.batches import Batches
from service.retention.rules import measurement_rules
from service.storage import Repository
from service.timing.wall_clock import WallClock

PERIOD_S = 60.0

log = structlog.get_logger(__name__)


class Housekeeping:
    """Keeps the measurements of the database to the times that the settings give.

    A clock that is ahead must not delete anything, so deleting waits until the clock has proved stable. After
    the clock was set, averaging waits for that too, because an interval may seem to be over that is not.
    Neither loses anything by waiting.
    """

    def __init__(self, settings: Settings, repository: Repository, stopping: Event | None = None) -> None:
        """stopping: set when deleting should end, though there is more to delete."""
        self._stopping = stopping or Event()
        self._repository = repository
        self._settings = settings
        self._clock = WallClock()

    def average_and_delete(self, now_ns: int, monotonic_ns: int) -> None:
        """Average, then delete, as far as the wall clock can be trusted. Raises SQLAlchemyError.

        On PostgreSQL, make the partitions of the time under way and of the next before: also those of a clock
        that is wrong, for values come with its times.
        """
        self._clock.compare(now_ns, monotonic_ns)
        made = self._repository.make_measurement_partitions(now_ns=now_ns)
        if made:
            log.info("partitions of measured values made", partitions=made)
        if self._clock.was_set:
            return
        self._repository.average_measurements(now_ns=now_ns)
        if not self._clock.is_settled:
            return
        batches = Batches(stop=self._stopping)
        for rule in measurement_rules(self._settings, self._repository, now_ns):
            rule.forget(batches)
