"""How often records of a name proved not to be as listed today."""

from collections import Counter
from collections.abc import Iterable

from core.units import NANOSECONDS_PER_DAY

MOST_NAMES = 1000
"""Beyond that, only names that are still listed are remembered."""


class WrongListings:
    """Counts by names, for one day of UTC.

    A relay may list a file with another size and time at each look. It is then another record each time, so
    that no count of one record's attempts ever ends.
    """

    def __init__(self) -> None:
        self._day = 0
        self._numbers: Counter[str] = Counter()

    def note(self, name: str, now_ns: int) -> None:
        """Count one more."""
        self._begin_day(now_ns)
        self._numbers[name] += 1

    def number(self, name: str, now_ns: int) -> int:
        """Return how many there were today."""
        self._begin_day(now_ns)
        return self._numbers[name]

    def prune(self, listed: Iterable[str]) -> None:
        """Forget names that are gone, once there are many."""
        if len(self._numbers) > MOST_NAMES:
            self._numbers = Counter({name: self._numbers[name] for name in listed if name in self._numbers})

    def _begin_day(self, now_ns: int) -> None:
        day = now_ns // NANOSECONDS_PER_DAY
        if day != self._day:
            self._day = day
            self._numbers.clear()
