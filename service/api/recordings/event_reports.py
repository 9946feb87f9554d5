"""Recording requests, under the name the REST contract gives them: event reports."""

import time
from http import HTTPStatus
from typing import Annotated
from uuid import UUID

from fastapi import APIRouter, Header, Query, Request, Response

from service.access.permissions import Permission
from service.api.access.callers import By
from service.api.access.requirements import require
from service.api.context import Context, path_to
from service.api.document import Name
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import problems
from service.api.recordings.schemas import EventReport, RecordingWanted

router = APIRouter(tags=["event reports"])

IdempotencyKey = Annotated[
    str | None,
    Header(
        min_length=1,
        max_length=200,
        description="The same key again gives the first recording request instead of another one.",
    ),
]


@router.post(
    "/motors/{name}/event-reports",
    status_code=HTTPStatus.ACCEPTED,
    responses=problems(400, 404, 409, 413, 429)
    | {
        202: {
            "headers": {"Location": {"schema": {"type": "string"}, "description": "The recording request."}}
        }
    },
    dependencies=[require(Permission.TRIGGER)],
)
def request_event_report(
    context: Context,
    request: Request,
    response: Response,
    name: Name,
    caller: By,
    idempotency_key: IdempotencyKey = None,
    wanted: RecordingWanted | None = None,
) -> EventReport:
    """Request a recording from the motor's relay. Follow the request until it is diagnosed or failed.

    With `seconds` the relay makes a series of recordings that overlap, which are joined to one.
    """
    recording_request = context.repository.request_recording(
        name,
        by=caller,
        now_ns=time.time_ns(),
        idempotency_key=idempotency_key,
        most_open=context.settings.max_open_requests,
        seconds=None if wanted is None else wanted.seconds,
    )
    response.headers["Location"] = path_to(request, "get_event_report", report_id=recording_request.id)
    return EventReport.model_validate(recording_request)


@router.get("/event-reports", responses=problems(404), dependencies=[require(Permission.VIEW)])
def list_event_reports(
    context: Context,
    motor: Annotated[str | None, Query(max_length=200)] = None,
    limit: Limit = DEFAULT_LIMIT,
    cursor: CursorText = None,
) -> Page[EventReport]:
    """Return the recording requests of one motor or of all motors, latest first."""
    context.require_motor(motor)
    requests = context.repository.recording_requests(motor=motor, limit=limit, after=decode(cursor, int, str))
    return page(requests, EventReport.model_validate)


@router.get("/event-reports/{report_id}", responses=problems(404), dependencies=[require(Permission.VIEW)])
def get_event_report(context: Context, report_id: UUID) -> EventReport:
    """Return one recording request."""
    return EventReport.model_validate(context.repository.recording_request(str(report_id)))
