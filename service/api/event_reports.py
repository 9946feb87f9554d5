"""Recording requests, under the name the REST contract gives them: event reports."""

import time
from http import HTTPStatus
from typing import Annotated
from uuid import UUID

from fastapi import APIRouter, Header, Query, Request, Response

from service.api.context import Context
from service.api.document import Name
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import problems
from service.api.schemas import EventReport

router = APIRouter(tags=["event reports"])

IdempotencyKey = Annotated[
    str | None,
    Header(
        min_length=1,
        max_length=200,
        description="The same key again gives the first request's event report instead of another one.",
    ),
]


@router.post(
    "/motors/{name}/event-reports",
    status_code=HTTPStatus.ACCEPTED,
    responses=problems(404, 409)
    | {202: {"headers": {"Location": {"schema": {"type": "string"}, "description": "The event report."}}}},
)
def request_event_report(
    context: Context,
    request: Request,
    response: Response,
    name: Name,
    idempotency_key: IdempotencyKey = None,
) -> EventReport:
    """Asks the motor's relay for an event recording. Follow the event report until diagnosed or failed."""
    wanted = context.repository.request_recording(
        name, now_ns=time.time_ns(), idempotency_key=idempotency_key
    )
    response.headers["Location"] = request.url_for("get_event_report", report_id=wanted.id).path
    return EventReport.model_validate(wanted)


@router.get("/event-reports", responses=problems())
def list_event_reports(
    context: Context,
    motor: Annotated[str | None, Query(max_length=200)] = None,
    limit: Limit = DEFAULT_LIMIT,
    cursor: CursorText = None,
) -> Page[EventReport]:
    """Event reports, of one motor or of all, latest first."""
    requests = context.repository.recording_requests(motor=motor, limit=limit, after=decode(cursor, int, str))
    return page(requests, EventReport.model_validate)


@router.get("/event-reports/{report_id}", responses=problems(404))
def get_event_report(context: Context, report_id: UUID) -> EventReport:
    """One event report."""
    return EventReport.model_validate(context.repository.recording_request(str(report_id)))
