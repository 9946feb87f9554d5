"""The back-ups that were made of this service's data. They are made and restored by the command line."""

from fastapi import APIRouter
from pydantic import Field

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.context import Context
from service.api.document import Document
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import problems
from service.api.times import Time
from service.storage.states import BackupState

router = APIRouter(tags=["operation"])


class Backup(Document):
    """A back-up: `running`, `verified` (every file was read again) or `failed`, with the problem.

    due_time: the time of the schedule that it was made for; null where somebody asked for it.
    """

    id: str
    state: BackupState
    name: str | None
    directory: str
    due_time: Time | None = Field(validation_alias="due_ns")
    began_time: Time = Field(validation_alias="began_ns")
    ended_time: Time | None = Field(validation_alias="ended_ns")
    recordings: int | None
    files: int | None
    size_bytes: int | None
    problem: str | None


@router.get("/backups", responses=problems(), dependencies=[require(Permission.CONFIGURE)])
def list_backups(context: Context, limit: Limit = DEFAULT_LIMIT, cursor: CursorText = None) -> Page[Backup]:
    """Return the back-ups of the service's data, latest first."""
    found = context.repository.backups(limit=limit, after=decode(cursor, int, str))
    return page(found, Backup.model_validate)
