"""Deletes once a day what the settings say is old enough, and removes the folders that nothing needs."""

from threading import Event

import structlog

from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND
from service.configuration.settings import Settings
from service.recording_store.store import RecordingStore
from service.retention.batches import Batches
from service.retention.deletion import remove_discarded_folders
from service.retention.rules import Rule, rules
from service.retention.unknown_folders import UnknownFolderSweep
from service.storage import Repository
from service.timing.wall_clock import WallClock

log = structlog.get_logger(__name__)

PERIOD_S = 60.0


class Retention:
    """Applies the rules of [retention] once a day, round by round, as far as the wall clock can be trusted.

    Housekeeping sees to the measured values, which need it every minute.
    """

    def __init__(
        self,
        settings: Settings,
        repository: Repository,
        store: RecordingStore,
        stopping: Event | None = None,
    ) -> None:
        """stopping: set when deleting should end, though there is more to delete."""
        self._settings = settings
        self._repository = repository
        self._store = store
        self._stopping = stopping or Event()
        self._clock = WallClock()
        self._sweep = UnknownFolderSweep(repository, store.unknown)
        self._left: list[Rule] = []
        self._next_ns: int | None = None

    def delete_old(self, now_ns: int, monotonic_ns: int) -> None:
        """Do one round. Raises SQLAlchemyError, OSError."""
        self._clock.compare(now_ns, monotonic_ns)
        if self._clock.is_settled:
            self._apply_rules(now_ns, monotonic_ns)
            self._sweep.sweep_a_part(now_ns / NANOSECONDS_PER_SECOND)
        remove_discarded_folders(self._repository, self._store, now_ns, self._stopping)

    def _apply_rules(self, now_ns: int, monotonic_ns: int) -> None:
        if not self._left:
            if self._next_ns is not None and monotonic_ns < self._next_ns:
                return
            self._next_ns = monotonic_ns + NANOSECONDS_PER_DAY
            every = rules(self._settings, self._repository, now_ns)
            self._left = [rule for rule in every if rule.days is not None]
        batches = Batches(stop=self._stopping)
        while self._left:
            rule = self._left[0]
            number = rule.forget(batches)
            if number:
                log.info("old data deleted", rule=rule.setting, days=rule.days, number=number)
            if batches.is_over:
                return
            self._left.pop(0)
