"""Deleting a recording, and the list of those that were deleted."""

import time
from http import HTTPStatus
from typing import Annotated
from uuid import UUID

from fastapi import APIRouter, Query
from pydantic import Field, StringConstraints

from core.diagnosis.verdict import Verdict
from service.access.permissions import Permission
from service.api.access.callers import By
from service.api.access.requirements import require
from service.api.context import ApiContext, Context
from service.api.document import Document
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import problems
from service.api.recordings.schemas import Recording
from service.api.times import Time
from service.retention import deletion as deleting
from service.storage.records import Actor, RecordingEntry
from service.storage.states import DeletedBy, RecordingSource, RecordingState

router = APIRouter(tags=["recordings"])

Reason = Annotated[
    str,
    StringConstraints(min_length=1, max_length=500, strip_whitespace=True, pattern=r"^[^\x00]+$"),
    Query(description="Why, in words; it is kept with the time."),
]


class Deletion(Document):
    """A recording that was deleted, under the id that it had: what it was, when, by whom and why.

    deleted_by: `person` or `retention`, a rule of the settings.
    """

    id: str
    motor: str
    ied: str | None
    source: RecordingSource
    name: str
    sha256: str | None = Field(validation_alias="digest")
    size_bytes: int
    state: RecordingState
    verdict: Verdict | None
    announced_time: Time = Field(validation_alias="announced_ns")
    recorded_time: Time | None = Field(validation_alias="recorded_ns")
    deleted_time: Time = Field(validation_alias="deleted_ns")
    deleted_by: DeletedBy
    reason: str


@router.delete(
    "/recordings/{recording_id}",
    status_code=HTTPStatus.NO_CONTENT,
    responses=problems(404, 409),
    dependencies=[require(Permission.RECORDINGS)],
)
def delete_recording(context: Context, recording_id: UUID, reason: Reason, caller: By) -> None:
    """Delete a recording with its files and diagnoses; it is not pulled from its relay again.

    The same account can undo it for ten minutes.
    """
    deleting.delete_recording(context.repository, str(recording_id), reason, by=caller, now_ns=time.time_ns())


@router.get("/deletions", responses=problems(404), dependencies=[require(Permission.VIEW)])
def list_deletions(
    context: Context,
    motor: Annotated[str | None, Query(max_length=200)] = None,
    limit: Limit = DEFAULT_LIMIT,
    cursor: CursorText = None,
) -> Page[Deletion]:
    """Return the recordings that were deleted, of one motor or of all, latest first."""
    context.require_motor(motor)
    deletions = context.repository.deletions(motor=motor, limit=limit, after=decode(cursor, int, str))
    return page(deletions, Deletion.model_validate)


@router.get("/deletions/{recording_id}", responses=problems(404), dependencies=[require(Permission.VIEW)])
def get_deletion(context: Context, recording_id: UUID) -> Deletion:
    """Return what is remembered of one recording that was deleted."""
    return Deletion.model_validate(context.repository.deletion(str(recording_id)))


@router.post(
    "/deletions/{recording_id}/undo",
    responses=problems(404, 409),
    dependencies=[require(Permission.RECORDINGS)],
)
def undo_deletion(context: Context, recording_id: UUID, caller: By) -> Recording:
    """Have a recording back that the same account has deleted in the last ten minutes.

    It has its id, files and times again, and waits for its diagnosis.
    """
    return Recording.model_validate(undone_deletion(context, str(recording_id), caller))


def undone_deletion(context: ApiContext, recording_id: str, by: Actor) -> RecordingEntry:
    """Undo a deletion, and have the recording diagnosed. Raises NotFoundError, DeletionStaysError."""
    entry = deleting.undo_deletion(
        context.repository, context.store, recording_id, by=by, now_ns=time.time_ns()
    )
    context.on_new_job()
    return entry
