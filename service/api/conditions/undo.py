"""Undo of a reset baseline, of a note that began the assessment anew, and of a retraction."""

import time
from collections.abc import Iterable
from http import HTTPStatus
from uuid import UUID

from fastapi import APIRouter

from core.condition.events import EventKind
from service.access.permissions import Permission
from service.api.access.callers import By
from service.api.access.requirements import require
from service.api.conditions.notes import keep_note
from service.api.conditions.schemas import Note
from service.api.context import ApiContext, Context
from service.api.document import Name
from service.api.problems import ProblemError, problems
from service.storage.records import Actor, ConditionEvent
from service.timing.undo_time import UNDO_MINUTES, UNDO_NS

router = APIRouter(prefix="/motors/{name}", tags=["condition"])


@router.post(
    "/notes/{note_id}/undo", responses=problems(404, 409), dependencies=[require(Permission.CONFIGURE)]
)
def undo_note(context: Context, name: Name, note_id: UUID, caller: By) -> Note:
    """Undo within ten minutes what the same account did to a note: that it was written, or retracted.

    One that was written is withdrawn; one that was retracted is kept again, as a new note of the same time.
    """
    return undone(context, name, str(note_id), caller, time.time_ns())


def undone(context: ApiContext, motor: str, note_id: str, by: Actor, now_ns: int) -> Note:
    """Undo what became of a note last; return what counts now. Raises NotFoundError, ProblemError (409)."""
    note = context.repository.event(motor, note_id)
    if not may_undo(note, by.name, now_ns):
        raise ProblemError(
            HTTPStatus.CONFLICT,
            f"expected a note that you wrote or retracted in the last {UNDO_MINUTES} minutes: retract it "
            "with a reason, or write it again",
        )
    if note.withdrawn_ns is not None:
        return keep_note(context, motor, note.kind, note.reason, by, note.on_behalf_of, note.time_ns)
    reason = f"undone within {UNDO_MINUTES} minutes"
    withdrawn = context.repository.withdraw_event(motor, note.id, by=by, reason=reason, now_ns=now_ns)
    context.on_new_job()
    return Note.model_validate(withdrawn)


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
