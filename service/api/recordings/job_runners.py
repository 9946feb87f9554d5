"""Who makes the diagnoses: the job runners of all services and workers on this database."""

from fastapi import APIRouter
from pydantic import Field

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.context import Context
from service.api.document import Document
from service.api.pages import Page
from service.api.problems import problems
from service.api.times import Time

router = APIRouter(tags=["recordings"])


class JobRunner(Document):
    """A process that has diagnoses made: `workers` at once, `jobs` of them at present."""

    id: str
    host: str
    process_id: int
    workers: int
    started_time: Time = Field(validation_alias="started_ns")
    jobs: int


@router.get("/job-runners", responses=problems(), dependencies=[require(Permission.VIEW)])
def list_job_runners(context: Context) -> Page[JobRunner]:
    """Return the processes that have diagnoses made, on all hosts, by id; always one page."""
    runners = context.repository.job_runners()
    return Page(items=[JobRunner.model_validate(entry) for entry in runners], next_cursor=None)
