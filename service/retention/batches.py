"""Long deletions in short transactions, with pauses in which others write.

SQLite has one writer. A gateway whose lease cannot be renewed ends itself, so nothing may hold the writer for
more than a moment, however much there is to delete.
"""

from collections.abc import Callable
from dataclasses import dataclass
from threading import Event
from time import monotonic

from service.storage.records import DeletedRows

FIRST_ROWS = 200
"""Rows of the first batch, before it is known how long they take."""

LARGEST_GROWTH = 2.0
"""A batch has at most so many times the rows of the one before: one quick batch proves little."""


@dataclass(frozen=True, slots=True)
class Pace:
    """How deleting shares the database with others.

    batch_s: how long one transaction should take [s].  most_rows: rows of one transaction, whatever the time.
    round_s: how long one round of deleting may take [s]; the next round goes on where this one ended.
    rest: how long others have the database between two batches, as a multiple of the time of a batch.
    """

    batch_s: float = 0.05
    most_rows: int = 20_000
    round_s: float = 20.0
    rest: float = 1.0


PACE = Pace()


class Batches:
    """Deletes in batches until nothing is left, the round is over, or somebody asks to stop.

    The rows of a batch follow from the time that the batch before took.
    """

    def __init__(self, pace: Pace = PACE, stop: Event | None = None) -> None:
        """stop: set by whoever wants the work to end after the batch under way.

        largest_s: how long the longest batch took [s].
        """
        self._pace = pace
        self._stop = stop or Event()
        self._end_s = monotonic() + pace.round_s
        self.largest_s = 0.0

    @property
    def is_over(self) -> bool:
        """Return whether no further batch may begin."""
        return self._stop.is_set() or monotonic() >= self._end_s

    def run(self, delete: Callable[[int], DeletedRows], first_rows: int = FIRST_ROWS) -> int:
        """Call `delete` with the most rows it may delete until it deletes none; return how many it deleted.

        It returns earlier where the round is over.
        """
        number = 0
        rows = min(first_rows, self._pace.most_rows)
        while not self.is_over:
            deleted = delete(rows)
            if deleted.rows == 0:
                break
            number += deleted.rows
            self.largest_s = max(self.largest_s, deleted.took_s)
            rows = self._adapted(rows, deleted.took_s)
            self._stop.wait(deleted.took_s * self._pace.rest)
        return number

    def _adapted(self, rows: int, took_s: float) -> int:
        growth = min(LARGEST_GROWTH, self._pace.batch_s / max(took_s, 1e-6))
        return max(1, min(self._pace.most_rows, int(rows * growth)))
