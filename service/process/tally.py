"""Counts what may happen thousands of times a second, for one line in the log a minute."""

from collections import Counter

import structlog
from structlog.typing import FilteringBoundLogger

log: FilteringBoundLogger = structlog.get_logger(__name__)

PERIOD_S = 60.0


class Tally:
    """Counts of events by name. `event`: what they have in common, the first words of the line."""

    def __init__(self, event: str) -> None:
        self._event = event
        self._counts: Counter[str] = Counter()
        self._next_line_s = 0.0

    def add(self, name: str) -> None:
        """Count one."""
        self._counts[name] += 1

    def tell(self, now_s: float) -> None:
        """Log what was counted since the last line, if anything was; at most once in PERIOD_S.

        now_s: of a clock that only goes forward. The first event is told at the first call after it.
        """
        if self._counts and now_s >= self._next_line_s:
            log.warning(self._event, **self._counts)
            self._counts.clear()
            self._next_line_s = now_s + PERIOD_S
