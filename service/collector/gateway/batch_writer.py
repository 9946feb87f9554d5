"""Write what comes often and matters little one by one: all relays together, in one transaction a second.

With a transaction for each, hundreds of relays would wait for the one writer that SQLite allows, and so would
what cannot wait: the renewal of their leases.
"""

import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from functools import partial
from queue import SimpleQueue
from typing import Generic, TypeVar

import structlog
from sqlalchemy.exc import DBAPIError

from service.storage import Repository
from service.storage.records import ClockNote, LinkNote, RelayFindings, ReportPosition, Sample
from service.timing.database_silence import does_not_answer
from service.timing.periodic_worker import PeriodicWorker

log = structlog.get_logger(__name__)

Item = TypeVar("Item")

PERIOD_S = 1.0
"""Between transactions."""

MOST_UNWRITTEN = 100_000
"""So many items of a kind are kept while the database does not answer; beyond that the oldest are dropped."""


MOST_REFUSED = 100
"""Items are found one by one that the database refuses, so many in a round; the rest waits for the next."""

TELL_PERIOD_S = 60.0
"""Between lines of the log that say how many items were dropped."""


class BatchRefusedError(RuntimeError):
    """The database refuses items, which are lost."""


class BatchWriter:
    """Collect items from the threads of the sessions, and write them from a thread of its own."""

    def __init__(
        self, repository: Repository, *, gateway: str | None = None, period_s: float = PERIOD_S
    ) -> None:
        """Prepare the thread.

        gateway: writes the states of those links alone that it holds then; None where there are no leases.
        period_s: between transactions.
        """
        self._samples = _Batch("measured values", repository.add_samples)
        self._notes = _Batch("notes of links", partial(repository.note_links, gateway=gateway))
        self._findings: _Batch[RelayFindings] = _Batch(
            "what was found at relays", lambda findings: repository.note_findings(*findings)
        )
        self._clocks = _Batch("readings of clocks", repository.note_clocks)
        self._positions = _Batch("places in the relays' reports", repository.save_report_positions)
        self._worker = PeriodicWorker("the batch writer", self._write, period_s=period_s, once_more=True)

    def add_sample(self, sample: Sample) -> None:
        """Write what a relay measured."""
        self._samples.add(sample)

    def add_note(self, note: LinkNote) -> None:
        """Write what went over a link, and the state it has from then on."""
        self._notes.add(note)

    def add_findings(self, findings: RelayFindings) -> None:
        """Write what was found at a relay."""
        self._findings.add(findings)

    def add_clock(self, note: ClockNote) -> None:
        """Write how far a relay's clock is from ours."""
        self._clocks.add(note)

    def add_position(self, position: ReportPosition) -> None:
        """Write where to resume a relay's reports."""
        self._positions.add(position)

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
        with ExitStack() as writes:  # what goes wrong with items of one kind holds up none of the others
            for batch in (self._notes, self._clocks, self._positions, self._findings, self._samples):
                writes.callback(batch.write)


class _Batch(Generic[Item]):
    """Hold the items of one kind until they are written."""

    def __init__(self, kind: str, write: Callable[[Sequence[Item]], None]) -> None:
        self._kind = kind
        self._write = write
        self._arrived: SimpleQueue[Item] = SimpleQueue()
        self._unwritten: list[Item] = []
        self._dropped = 0
        self._told_s = -TELL_PERIOD_S

    def add(self, item: Item) -> None:
        self._arrived.put(item)

    def write(self) -> None:
        """Write all items, in one transaction where the database takes them all.

        Raises SQLAlchemyError where the database does not answer: the items are kept. Raises
        BatchRefusedError where it refuses some: those are lost, and the others are written.
        """
        while not self._arrived.empty():
            self._unwritten.append(self._arrived.get())
        self._drop_oldest()
        refused: list[Exception] = []
        parts = [self._unwritten] if self._unwritten else []
        while parts and len(refused) < MOST_REFUSED:
            part = parts.pop()
            try:
                self._write(part)
            except Exception as error:
                if does_not_answer(error):
                    self._unwritten = _joined([*parts, part])
                    raise
                if len(part) == 1:
                    refused.append(error)
                else:
                    middle = len(part) // 2
                    parts += [part[middle:], part[:middle]]
        self._unwritten = _joined(parts)
        if refused:
            first = refused[0]
            reason = first.orig if isinstance(first, DBAPIError) else first  # without the whole statement
            raise BatchRefusedError(
                f"lost {len(refused)} items, the database refuses them: {reason}"
            ) from first

    def _drop_oldest(self) -> None:
        """Drop what is too much to keep, and say so now and then."""
        excess = len(self._unwritten) - MOST_UNWRITTEN
        if excess > 0:
            del self._unwritten[:excess]
            self._dropped += excess
        if self._dropped and time.monotonic() - self._told_s >= TELL_PERIOD_S:
            log.warning(
                "dropped: the database has not taken them for too long", kind=self._kind, number=self._dropped
            )
            self._dropped = 0
            self._told_s = time.monotonic()


def _joined(parts: Sequence[list[Item]]) -> list[Item]:
    """Return the items of a stack of parts in the order in which they came; the first part is on top."""
    return [item for part in reversed(parts) for item in part]
