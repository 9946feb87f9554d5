"""Measured values over time: averages them while they are fresh, and forgets them when they are old."""

import time
from threading import Event, Thread

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.configuration.settings import Settings
from service.storage import Repository
from service.timing.wall_clock import WallClock

log = structlog.get_logger(__name__)

PERIOD_S = 60.0
DAY_NS = 86_400 * 1_000_000_000


class Housekeeping:
    """One thread, once a minute.

    Nothing is forgotten by a clock that may be ahead, and after one was set no mean is made of an interval
    that may not be over: both wait until it has settled, and lose nothing by it.
    """

    def __init__(self, settings: Settings, repository: Repository) -> None:
        self._repository = repository
        self._days = {
            0: settings.metering_sample_days,
            60: settings.metering_minute_days,
            900: settings.metering_quarter_hour_days,
        }
        self._clock = WallClock()
        self._stopping = Event()
        self._thread = Thread(target=self._run, name="housekeeping", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        self._stopping.set()
        self._thread.join()

    def tidy(self, now_ns: int, monotonic_ns: int) -> None:
        """Average, then forget, as far as the clock is to be trusted. Raises SQLAlchemyError: try again."""
        self._clock.look(now_ns, monotonic_ns)
        if self._clock.was_set:
            return
        self._repository.average_measurements(now_ns=now_ns)
        if not self._clock.is_settled:
            return
        for step_s, days in self._days.items():
            self._repository.forget_measurements(step_s, before_ns=now_ns - round(days * DAY_NS))

    def _run(self) -> None:
        while True:
            try:
                self.tidy(time.time_ns(), time.monotonic_ns())
            except SQLAlchemyError as error:
                log.warning("database does not answer, trying again", error=str(error))
            if self._stopping.wait(PERIOD_S):
                return
