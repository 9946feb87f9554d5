"""Fetches one record from a relay into a place in the recording store: every byte of every file.

A relay may send only so much in a day, so that one faulty relay cannot fill the disk for all.
"""

from collections.abc import Callable

from core.units import NANOSECONDS_PER_DAY
from mms import Client
from service.collector.records.errors import RecordTooLargeError
from service.collector.records.listing import ListedRecord
from service.recording_store.arriving import Incoming
from service.recording_store.arriving_file import ArrivingFile

BLOCK_BYTES = 4096
"""The smallest file takes so much of a disk, and counts for so much."""


class _Counted:
    """A file that reports how much was written to it."""

    def __init__(self, sink: ArrivingFile, on_bytes: Callable[[int], None]) -> None:
        self._sink = sink
        self._on_bytes = on_bytes

    def write(self, chunk: bytes, /) -> None:
        self._sink.write(chunk)
        self._on_bytes(len(chunk))


def pull(
    client: Client,
    record: ListedRecord,
    incoming: Incoming,
    *,
    max_file_bytes: int,
    on_bytes: Callable[[int], None],
) -> None:
    """Stream the files of one record to where they arrive; `on_bytes` gets the size of every part that came.

    Raises RecordTooLargeError, MmsError (FileSizeMismatch when a file is not as long as listed),
    RecordingStoreError for a name the store refuses, OSError when the disk does.
    """
    for file in record.files:
        if file.size > max_file_bytes:
            raise RecordTooLargeError(
                f"{file.local_name}: expected at most {max_file_bytes} bytes (setting max_file_bytes), "
                f"found {file.size}"
            )
    for file in record.files:
        with incoming.create(file.local_name) as sink:
            client.download(file.remote_name, _Counted(sink, on_bytes), expected_size=file.size)


class DailyAllowance:
    """Counts the bytes that one relay sent, by days of UTC, and says whether more may be pulled.

    The first record of a day is always allowed: a limit smaller than one record delays, it does not refuse.
    """

    def __init__(self, limit_bytes: int, *, day: int = 0, used_bytes: int = 0) -> None:
        self.limit_bytes = limit_bytes
        self.day = day
        self.used_bytes = used_bytes

    def resume(self, day: int, used_bytes: int) -> None:
        """Go on from what was counted before."""
        self.day, self.used_bytes = day, used_bytes

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
