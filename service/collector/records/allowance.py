"""How much a relay may send in a day, so that one relay gone wild cannot fill the disk for all."""

from core.units import NANOSECONDS_PER_DAY

BLOCK_BYTES = 4096
"""What even the smallest file takes on a disk, and counts for."""


class DailyAllowance:
    """Bytes of one relay, counted by days of UTC.

    The first record of a day is always allowed: a limit smaller than one record delays, it does not refuse.
    """

    def __init__(self, limit_bytes: int, *, day: int = 0, used_bytes: int = 0) -> None:
        self.limit_bytes = limit_bytes
        self.day = day
        self.used_bytes = used_bytes

    def allows(self, sizes: tuple[int, ...], now_ns: int) -> bool:
        """Whether files of these sizes fit into what is left of the day."""
        self._begin_day(now_ns)
        return self.used_bytes == 0 or self.used_bytes + sum(map(on_disk, sizes)) <= self.limit_bytes

    def charge(self, number_of_bytes: int, now_ns: int) -> None:
        """So many came, whatever became of them."""
        self._begin_day(now_ns)
        self.used_bytes += number_of_bytes

    def _begin_day(self, now_ns: int) -> None:
        day = now_ns // NANOSECONDS_PER_DAY
        if day != self.day:
            self.day, self.used_bytes = day, 0


def on_disk(size: int) -> int:
    """Size in whole blocks, at least one [bytes]."""
    return max(1, -(-size // BLOCK_BYTES)) * BLOCK_BYTES


def beyond_its_end(size: int) -> int:
    """What a file of this size leaves empty of its last block [bytes]."""
    return on_disk(size) - size
