"""Notes: what people tell of a motor, and that it counts as healthy as it is."""

import time
from http import HTTPStatus
from uuid import UUID

from fastapi import APIRouter, Request, Response

from core.condition.events import Event, EventKind
from core.units import NANOSECONDS_PER_DAY
from service.access.permissions import Permission
from service.api.access.callers import Asking, By
from service.api.access.requirements import require
from service.api.conditions.schemas import Note, NoteRequest, RestartRequest, Withdrawal
from service.api.context import ApiContext, Context, path_to
from service.api.document import Name
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import WrongFieldError, problems
from service.api.times import rfc3339
from service.storage.records import Actor

FURTHEST_AHEAD_NS = NANOSECONDS_PER_DAY
"""No note lies further in the future. Clocks of relays, which order the records, may be hours ahead."""

_MADE: dict[int | str, dict[str, object]] = {
    201: {"headers": {"Location": {"schema": {"type": "string"}, "description": "The note."}}}
}

router = APIRouter(prefix="/motors/{name}", tags=["condition"])


@router.get("/notes", responses=problems(404), dependencies=[require(Permission.VIEW)])
def list_notes(
    context: Context, name: Name, limit: Limit = DEFAULT_LIMIT, cursor: CursorText = None
) -> Page[Note]:
    """Return what people told of a motor, and what its files told, latest first."""
    return page(
        context.repository.events(name, limit=limit, after=decode(cursor, int, str)), Note.model_validate
    )


@router.post(
    "/notes",
    status_code=HTTPStatus.CREATED,
    responses=problems(400, 404, 409, 413) | _MADE,
    dependencies=[require(Permission.NOTE)],
)
def add_note(
    context: Context, request: Request, response: Response, name: Name, wanted: NoteRequest, asking: Asking
) -> Note:
    """Keep what a person tells of a motor; its condition follows within seconds.

    All kinds but `note` change what the condition follows from, and need the permission `configure`.
    """
    if wanted.kind is not EventKind.NOTE:
        asking.demand(Permission.CONFIGURE, f"tell of {wanted.kind.value}")
    caller = asking.actor
    note = keep_note(context, name, wanted.kind, wanted.text, caller, wanted.on_behalf_of, wanted.time)
    response.headers["Location"] = path_to(request, "get_note", name=name, note_id=note.id)
    return note


@router.get("/notes/{note_id}", responses=problems(404), dependencies=[require(Permission.VIEW)])
def get_note(context: Context, name: Name, note_id: UUID) -> Note:
    """Return one note."""
    return Note.model_validate(context.repository.event(name, str(note_id)))


@router.post(
    "/notes/{note_id}/withdrawal",
    responses=problems(400, 404, 409, 413),
    dependencies=[require(Permission.CONFIGURE)],
)
def withdraw_note(context: Context, name: Name, note_id: UUID, wanted: Withdrawal, caller: By) -> Note:
    """Let a note that was wrong count no more; the condition follows as if nobody had told it."""
    note = context.repository.withdraw_event(
        name,
        str(note_id),
        by=caller,
        on_behalf_of=wanted.on_behalf_of,
        reason=wanted.reason,
        now_ns=time.time_ns(),
    )
    context.on_new_job()
    return Note.model_validate(note)


@router.post(
    "/reference",
    status_code=HTTPStatus.CREATED,
    responses=problems(400, 404, 409, 413) | _MADE,
    dependencies=[require(Permission.CONFIGURE)],
)
def restart_reference(
    context: Context, request: Request, response: Response, name: Name, wanted: RestartRequest, caller: By
) -> Note:
    """Take the motor for healthy as it is: its standing asymmetry is learnt anew. The answer is a note."""
    kind = EventKind.REFERENCE_RESTARTED
    note = keep_note(context, name, kind, wanted.reason, caller, wanted.on_behalf_of, wanted.time)
    response.headers["Location"] = path_to(request, "get_note", name=name, note_id=note.id)
    return note


def keep_note(
    context: ApiContext,
    motor: str,
    kind: EventKind,
    text: str,
    by: Actor,
    on_behalf_of: str | None,
    time_ns: int | None,
) -> Note:
    """Keep what somebody tells of a motor, and have its condition follow.

    time_ns: when it happened; None for now. Raises NotFoundError, OutOfServiceError, ProblemError,
    TooManyNotesError.
    """
    if kind is EventKind.PARAMETERS_EDITED:
        raise WrongFieldError(
            "body.kind",
            "what is edited in the motors file is noted by the service itself when it starts: edit the file"
            " and restart the service, or tell of it with the kind 'note'",
        )
    now_ns = time.time_ns()
    if time_ns is None:
        time_ns = now_ns
    if time_ns < 0:
        raise WrongFieldError("body.time", "expected a time after 1970, found an earlier one")
    if time_ns > now_ns + FURTHEST_AHEAD_NS:
        raise WrongFieldError(
            "body.time", f"expected a time at most a day ahead of now, found {rfc3339(time_ns)}"
        )
    # However much was noted of a motor before: who tested it can say that it is healthy.
    most_notes = None if kind is EventKind.REFERENCE_RESTARTED else context.settings.max_notes
    event = context.repository.add_event(
        motor,
        Event(time_ns, kind, text),
        by=by,
        on_behalf_of=on_behalf_of,
        now_ns=now_ns,
        most_notes=most_notes,
    )
    context.on_new_job()
    return Note.model_validate(event)
