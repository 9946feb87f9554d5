"""What is written often and matters little one by one: in one transaction a second for all relays together.

With a transaction for each, hundreds of relays would wait for the one writer that SQLite allows, and so would
what cannot wait: the renewal of their leases.
"""

from collections.abc import Callable, Sequence
from queue import SimpleQueue
from threading import Event, Thread
from typing import Generic, TypeVar

import structlog
from sqlalchemy.exc import InterfaceError, OperationalError, TimeoutError  # noqa: A004 - of the database

from service.storage import Repository
from service.storage.records import LinkNote, Sample

log = structlog.get_logger(__name__)

Item = TypeVar("Item")

PERIOD_S = 1.0
"""Between transactions."""

MOST_UNWRITTEN = 100_000
"""Of a kind, kept while the database does not answer; then the oldest go."""


NO_ANSWER = (OperationalError, InterfaceError, TimeoutError)
"""Of a database that is locked, full or away."""


class BatchWriter:
    """Filled by the relays' sessions, from their threads; written by a thread of its own."""

    def __init__(self, repository: Repository) -> None:
        self._samples = _Batch(repository.add_samples)
        self._notes = _Batch(repository.note_links)
        self._closed = Event()
        self._thread = Thread(target=self._run, name="batches", daemon=True)

    def add_sample(self, sample: Sample) -> None:
        """What a relay measured."""
        self._samples.add(sample)

    def add_note(self, note: LinkNote) -> None:
        """What went over a link that is up, and still is."""
        self._notes.add(note)

    def start(self) -> None:
        self._thread.start()

    def stop(self, patience_s: float) -> None:
        """Write what there is, wait so long for it at most."""
        self._closed.set()
        self._thread.join(patience_s)

    def _run(self) -> None:
        closed = False
        while not closed:
            closed = self._closed.wait(PERIOD_S)
            self._samples.write_or_keep()
            self._notes.write_or_keep()


class _Batch(Generic[Item]):
    """Of one kind."""

    def __init__(self, write: Callable[[Sequence[Item]], None]) -> None:
        self._write = write
        self._arrived: SimpleQueue[Item] = SimpleQueue()
        self._unwritten: list[Item] = []

    def add(self, item: Item) -> None:
        self._arrived.put(item)

    def write_or_keep(self) -> None:
        """In one transaction; while the database does not answer, it is kept for the next time."""
        while not self._arrived.empty():
            self._unwritten.append(self._arrived.get())
        del self._unwritten[:-MOST_UNWRITTEN]
        if not self._unwritten:
            return
        try:
            self._write(self._unwritten)
        except NO_ANSWER as error:
            log.warning("database does not answer, trying again", error=str(error))
            return
        except Exception:  # one that will never be taken must not hold up all that come after it
            log.exception("lost, the database refuses it", number=len(self._unwritten))
        self._unwritten.clear()
