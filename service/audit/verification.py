"""Whether a chain of entries is as it was written, and if not, which entry is the first wrong one, and how.

What can be found from the chain alone: an entry changed, removed, put in or moved, and an end cut off below
the head that the database keeps. Whoever may write the database can also compute the whole chain anew from
any entry on. Only an anchor, an entry written down elsewhere, shows that.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from enum import StrEnum

from service.audit.entries import START, Anchor, AuditEntry, digest

Read = Callable[[], Iterable[AuditEntry]]
"""Reads all entries from the first on, again at each call."""

MOST_MOVED_UP = 1000
"""So many removed entries, whose places those behind them took, are told from a change."""


class Fault(StrEnum):
    """What was done to a chain."""

    CHANGED = "changed"
    REMOVED = "removed"
    INSERTED = "inserted"
    REORDERED = "reordered"
    CUT_OFF = "cut-off"
    REPLACED = "replaced"


@dataclass(frozen=True, slots=True)
class Verification:
    """What came of it: no fault up to the entry `last`, or `fault` in words.

    entries: those that are right. number: of the first entry that is wrong.
    """

    entries: int
    last: Anchor
    fault: Fault | None = None
    number: int | None = None
    message: str | None = None


def verify(
    read: Read, *, start: Anchor = START, head: Anchor | None = None, anchors: Iterable[Anchor] = ()
) -> Verification:
    """Read a chain, one entry after the other, up to the first that is wrong.

    start: the entry before the first one. head: what the database keeps as the last entry; None where that is
    not known, as of an export. anchors: entries that were written down elsewhere.
    """
    chain = _Chain(read, start, head, {anchor.number: anchor for anchor in anchors if anchor.number})
    for entry, following in _with_next(read()):
        wrong = chain.wrong(entry, following)
        if wrong is not None:
            return wrong
        chain.last = Anchor(entry.number, entry.hash)
        chain.entries += 1
    return chain.wrong_end() or Verification(chain.entries, chain.last)


@dataclass(slots=True)
class _Chain:
    """The entries that were found right, up to `last`; `unmet` are anchors behind it."""

    read: Read
    last: Anchor
    head: Anchor | None
    unmet: dict[int, Anchor] = field(default_factory=dict)
    entries: int = 0

    def wrong(self, entry: AuditEntry, following: AuditEntry | None) -> Verification | None:
        """Return what is wrong with the next entry, or with the place before it; None where nothing is."""
        due, number = self.last.number + 1, entry.number
        if digest(entry) != entry.hash:
            return self._not_its_hash(entry, following)
        if number != due:
            return self._not_its_turn(number, due)
        if entry.previous != self.last.hash:
            return self._not_linked(entry, following)
        if self.head is not None and number > self.head.number:
            told = f"entry {number} was put in behind the head: {self.head.number} entries were written"
            return self._fault(Fault.INSERTED, number, told)
        anchor = self.unmet.pop(number, None)
        if anchor is not None and anchor.hash != entry.hash:
            told = f"entry {number} is not the one of the anchor: it, or one before it, was replaced"
            return self._fault(Fault.REPLACED, number, f"{told}, and the hashes from there on computed anew")
        return None

    def wrong_end(self) -> Verification | None:
        """Return what is wrong behind the last entry: less than was written or seen; None for nothing."""
        last, head, seen = self.last, self.head, max(self.unmet, default=0)
        if head is not None and last.number < head.number:
            missing = _were(last.number + 1, head.number)
            return self._fault(Fault.CUT_OFF, last.number + 1, f"the end was cut off: {missing} written")
        if head is not None and last.hash != head.hash:
            told = f"entry {last.number} was changed: it is not the last one that was written"
            return self._fault(Fault.CHANGED, last.number, told)
        if seen:
            missing = _were(last.number + 1, seen)
            told = f"the end was cut off: {missing} written, as the anchor tells"
            return self._fault(Fault.CUT_OFF, last.number + 1, told)
        return None

    def _not_its_hash(self, entry: AuditEntry, following: AuditEntry | None) -> Verification:
        """Tell an entry that was changed from one that stands in another place than it was written for."""
        due, number = self.last.number + 1, entry.number
        written_as = self._written_as(entry)
        if written_as is None and following is not None and _was_written_as(following, number):
            told = f"entry {number} was put in: what stands behind it was written as {number}"
            return self._fault(Fault.INSERTED, number, told)
        if written_as is None:
            told = f"entry {number} was changed: its hash is that of other contents"
            return self._fault(Fault.CHANGED, number, told)
        told = f"what stands at {number} was written as {written_as}"
        if written_as < due:
            return self._fault(Fault.INSERTED, written_as, f"{_were(written_as, due - 1)} put in: {told}")
        if any(_was_written_as(other, due) for other in self.read()):
            return self._fault(Fault.REORDERED, due, f"entries were put in another order: {told}")
        return self._fault(Fault.REMOVED, due, f"{_were(due, written_as - 1)} removed: {told}")

    def _not_its_turn(self, number: int, due: int) -> Verification:
        if number < due or any(other.number == due for other in self.read()):
            told = f"entries are in another order: {number} stands behind {due - 1}"
            return self._fault(Fault.REORDERED, due, told)
        return self._fault(Fault.REMOVED, due, f"{_were(due, number - 1)} removed")

    def _not_linked(self, entry: AuditEntry, following: AuditEntry | None) -> Verification:
        """Tell which of two entries was written anew: both have their hashes, but do not belong together."""
        is_head = self.head == Anchor(entry.number, entry.hash)
        is_followed = is_head if following is None else following.previous == entry.hash
        number = self.last.number if is_followed and self.entries else entry.number
        told = (
            f"entry {number} was changed and its hash computed anew: entry {entry.number} follows another one"
        )
        return self._fault(Fault.CHANGED, number, told)

    def _written_as(self, entry: AuditEntry) -> int | None:
        """Return the number with which an entry has the hash that it has."""
        most = max(entry.number, 0 if self.head is None else self.head.number) + MOST_MOVED_UP
        return next((number for number in range(1, most + 1) if _was_written_as(entry, number)), None)

    def _fault(self, fault: Fault, number: int, message: str) -> Verification:
        return Verification(self.entries, self.last, fault, number, message)


def _was_written_as(entry: AuditEntry, number: int) -> bool:
    return digest(entry.at(number)) == entry.hash


def _were(first: int, last: int) -> str:
    return f"entry {first} was" if first == last else f"entries {first} to {last} were"


def _with_next(entries: Iterable[AuditEntry]) -> Iterator[tuple[AuditEntry, AuditEntry | None]]:
    """Yield each entry with the one behind it."""
    present: AuditEntry | None = None
    for following in entries:
        if present is not None:
            yield present, following
        present = following
    if present is not None:
        yield present, None
