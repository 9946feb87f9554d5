"""Write what comes often and matters little one by one: all relays together, in one transaction a second.

With a transaction for each, hundreds of relays would wait for the one writer that SQLite allows, and so would
what cannot wait: the renewal of their leases.
"""

from collections.abc import Callable, Sequence
from queue import SimpleQueue
from typing import Generic, TypeVar

from sqlalchemy.exc import DBAPIError

from service.storage import Repository
from service.storage.engine import NO_ANSWER
from service.storage.records import LinkNote, Sample
from service.timing.periodic_worker import PeriodicWorker

Item = TypeVar("Item")

PERIOD_S = 1.0
"""Between transactions."""

MOST_UNWRITTEN = 100_000
"""So many items of a kind are kept while the database does not answer; beyond that the oldest are dropped."""


class BatchRefusedError(RuntimeError):
    """The database refuses items, which are lost."""


class BatchWriter:
    """Collect items from the threads of the sessions, and write them from a thread of its own."""

    def __init__(self, repository: Repository, *, period_s: float = PERIOD_S) -> None:
        """Prepare the thread.

        period_s: between transactions.
        """
        self._samples = _Batch(repository.add_samples)
        self._notes = _Batch(repository.note_links)
        self._worker = PeriodicWorker("the batch writer", self._write, period_s=period_s, once_more=True)

    def add_sample(self, sample: Sample) -> None:
        """Write what a relay measured."""
        self._samples.add(sample)

    def add_note(self, note: LinkNote) -> None:
        """Write what went over a link that is up, and stays up."""
        self._notes.add(note)

    def start(self) -> None:
        """Start the thread."""
        self._worker.start()

    def stop(self, timeout_s: float) -> None:
        """Write what is left and end the thread; wait at most `timeout_s` for that."""
        self._worker.stop(timeout_s)

    def problem(self) -> str | None:
        """Return why items are not written at present; None while all is well."""
        return self._worker.problem()

    def _write(self) -> None:
        try:
            self._samples.write()
        finally:  # what goes wrong with items of one kind holds up none of the other
            self._notes.write()


class _Batch(Generic[Item]):
    """Hold the items of one kind until they are written."""

    def __init__(self, write: Callable[[Sequence[Item]], None]) -> None:
        self._write = write
        self._arrived: SimpleQueue[Item] = SimpleQueue()
        self._unwritten: list[Item] = []

    def add(self, item: Item) -> None:
        self._arrived.put(item)

    def write(self) -> None:
        """Write all items in one transaction.

        Raises SQLAlchemyError where the database does not answer: the items are kept. Raises
        BatchRefusedError where it refuses them: they are lost.
        """
        while not self._arrived.empty():
            self._unwritten.append(self._arrived.get())
        del self._unwritten[:-MOST_UNWRITTEN]
        if not self._unwritten:
            return
        try:
            self._write(self._unwritten)
        except NO_ANSWER:
            raise
        except Exception as error:  # items the database never takes must not hold up all that come after them
            lost = len(self._unwritten)
            self._unwritten.clear()
            reason = error.orig if isinstance(error, DBAPIError) else error  # without the whole statement
            raise BatchRefusedError(f"lost {lost} items, the database refuses them: {reason}") from error
        self._unwritten.clear()
