"""For whoever keeps the service running: alive, ready, and in figures."""

from http import HTTPStatus
from typing import Literal

from fastapi import APIRouter, Request, Response
from fastapi.responses import JSONResponse, PlainTextResponse
from pydantic import BaseModel
from sqlalchemy.exc import SQLAlchemyError

from service.access.permissions import Permission
from service.api.access.requirements import open_to_all, require
from service.api.context import ApiContext, Context
from service.api.metrics.exposition import MEDIA_TYPE, exposition
from service.api.problems import problem_response, problems
from service.timing.database_silence import database_trouble

router = APIRouter(tags=["operation"])


class Status(BaseModel):
    """Whether the service runs, or its parts work."""

    status: Literal["ok", "ready"]
    parts: dict[str, str] = {}


@router.head("/healthz", dependencies=[open_to_all()], include_in_schema=False)
@router.get("/healthz", dependencies=[open_to_all()])
async def get_health_of_service() -> Status:
    """Answer, which shows that the service runs."""
    # Without a thread, of which all may be busy, and without the database: it is answered under any load.
    return Status(status="ok")


@router.get(
    "/readyz", response_model=Status, responses={503: problems(503)[503]}, dependencies=[open_to_all()]
)
def get_readiness(context: Context, request: Request) -> Status | JSONResponse:
    """Tell whether all parts of the service work; otherwise answer 503, and say which does not and why."""
    parts = _parts(context)
    failing = {part: problem for part, problem in parts.items() if problem is not None}
    if not failing:
        return Status(status="ready", parts=dict.fromkeys(parts, "ready"))
    return problem_response(
        request.url.path,
        HTTPStatus.SERVICE_UNAVAILABLE,
        "; ".join(f"{part}: {problem}" for part, problem in failing.items()),
        parts={part: problem or "ready" for part, problem in parts.items()},
    )


@router.get("/metrics", response_class=PlainTextResponse, dependencies=[require(Permission.METRICS)])
def get_metrics(context: Context) -> Response:
    """Return the numbers of links, recording requests, recordings, jobs, alarms and motors by state.

    Also the figures of each link and of each motor's condition. Prometheus text format.
    """
    content = exposition(context.repository, context.settings.stale_after_days, context.refusals.counts())
    return Response(content, media_type=MEDIA_TYPE)


def _parts(context: ApiContext) -> dict[str, str | None]:
    parts: dict[str, str | None] = {"database": None}
    try:
        context.repository.check()
    except SQLAlchemyError as error:
        parts["database"] = database_trouble(error)
    return parts | {part: problem() for part, problem in context.readiness.items()}
