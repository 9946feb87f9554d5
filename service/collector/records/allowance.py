"""How much a relay may send in a day, so that one faulty relay cannot fill the disk for all."""

from core.units import NANOSECONDS_PER_DAY

BLOCK_BYTES = 4096
"""The smallest file takes so much of a disk, and counts for so much."""


class DailyAllowance:
    """Counts the bytes of one relay by days of UTC.

    The first record of a day is always allowed: a limit smaller than one record delays, it does not refuse.
    """

    def __init__(self, limit_bytes: int, *, day: int = 0, used_bytes: int = 0) -> None:
        self.limit_bytes = limit_bytes
        self.day = day
        self.used_bytes = used_bytes

    def allows(self, sizes: tuple[int, ...], now_ns: int) -> bool:
        """Return whether files of these sizes fit into what is left of the day."""
        self._begin_day(now_ns)
        return self.used_bytes == 0 or self.used_bytes + sum(map(on_disk, sizes)) <= self.limit_bytes

    def charge(self, number_of_bytes: int, now_ns: int) -> None:
        """Count bytes that came, whatever became of them."""
        self._begin_day(now_ns)
        self.used_bytes += number_of_bytes

    def _begin_day(self, now_ns: int) -> None:
        day = now_ns // NANOSECONDS_PER_DAY
        if day != self.day:
            self.day, self.used_bytes = day, 0


def on_disk(size: int) -> int:
    """Return a size in whole blocks, at least one [bytes]."""
    return max(1, -(-size // BLOCK_BYTES)) * BLOCK_BYTES


def beyond_its_end(size: int) -> int:
    """Return how much of its last block a file of this size leaves empty [bytes]."""
    return on_disk(size) - size
