"""What somebody may undo on a motor's page for ten minutes: a reset of the baseline, or a retraction."""

from collections.abc import Iterable

from core.condition.events import EventKind
from core.units import NANOSECONDS_PER_SECOND, SECONDS_PER_MINUTE
from service.storage.records import ConditionEvent

UNDO_MINUTES = 10
"""So long after it a click can be undone, by who made it."""
UNDO_NS = round(UNDO_MINUTES * SECONDS_PER_MINUTE * NANOSECONDS_PER_SECOND)


def may_undo(note: ConditionEvent, account: str, now_ns: int) -> bool:
    """Tell whether an account may undo what became of a note last: that it was written, or retracted."""
    if note.kind is EventKind.NOTE and note.withdrawn_ns is None:
        return False  # it changed nothing
    by, at_ns = note.withdrawn_account or note.account, note.withdrawn_ns or note.made_ns
    return by == account and 0 <= now_ns - at_ns <= UNDO_NS


def latest_to_undo(notes: Iterable[ConditionEvent], account: str, now_ns: int) -> ConditionEvent | None:
    """Return the note whose latest change may be undone, the latest of them."""
    found = [note for note in notes if may_undo(note, account, now_ns)]
    return max(found, key=lambda note: note.withdrawn_ns or note.made_ns, default=None)
