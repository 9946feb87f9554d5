"""What people found when they inspected motors: kept, counted, and used for no judgement."""

import time
from http import HTTPStatus
from typing import Annotated, Final
from uuid import UUID

from fastapi import APIRouter, Body, Path, Request, Response

from core.condition.kinds import Kind
from core.error_words import one_line
from service.access.permissions import Permission
from service.api.access.callers import By
from service.api.access.requirements import require
from service.api.conditions.notes import FURTHEST_AHEAD_NS
from service.api.context import ApiContext, Context, path_to
from service.api.document import Name
from service.api.inspections.pictures import JPEG, MAX_PICTURE_BYTES, PNG, picture_answer, picture_of
from service.api.inspections.schemas import (
    Inspection,
    InspectionCount,
    InspectionCounts,
    InspectionRequest,
    InspectionWithdrawal,
)
from service.api.limits.body_limits import BodyRule, Route
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import WrongFieldError, problems
from service.api.times import rfc3339
from service.storage.records import Actor, InspectionPicture, NewInspection
from service.storage.states import InspectionOutcome

PICTURE_TYPE: Final = "application/octet-stream"
PICTURE_ROUTES: Final[dict[Route, BodyRule]] = {
    ("POST", "/motors/{name}/inspections/{inspection_id}/pictures"): BodyRule(PICTURE_TYPE, MAX_PICTURE_BYTES)
}
"""Routes that take a picture."""

_MADE: dict[int | str, dict[str, object]] = {
    201: {"headers": {"Location": {"schema": {"type": "string"}, "description": "The inspection."}}}
}
_BINARY: Final = {"schema": {"type": "string", "format": "binary"}}
_PICTURE: dict[int | str, dict[str, object]] = {200: {"content": dict.fromkeys((PNG, JPEG), _BINARY)}}

router = APIRouter(tags=["inspections"])


@router.get("/motors/{name}/inspections", responses=problems(404), dependencies=[require(Permission.VIEW)])
def list_inspections(
    context: Context, name: Name, limit: Limit = DEFAULT_LIMIT, cursor: CursorText = None
) -> Page[Inspection]:
    """Return what inspections of a motor found, latest first; those that were withdrawn as well."""
    found = context.repository.inspections(name, limit=limit, after=decode(cursor, int, str))
    return page(found, Inspection.model_validate)


@router.post(
    "/motors/{name}/inspections",
    status_code=HTTPStatus.CREATED,
    responses=problems(400, 404, 409, 413) | _MADE,
    dependencies=[require(Permission.NOTE)],
)
def add_inspection(
    context: Context, request: Request, response: Response, name: Name, wanted: InspectionRequest, caller: By
) -> Inspection:
    """Keep what an inspection of a motor found. It is counted, and no judgement follows from it."""
    kept = keep_inspection(context, name, wanted, (), caller)
    response.headers["Location"] = path_to(request, "get_inspection", name=name, inspection_id=kept.id)
    return kept


@router.get(
    "/motors/{name}/inspections/{inspection_id}",
    responses=problems(404),
    dependencies=[require(Permission.VIEW)],
)
def get_inspection(context: Context, name: Name, inspection_id: UUID) -> Inspection:
    """Return one inspection."""
    return Inspection.model_validate(context.repository.inspection(name, str(inspection_id)))


@router.post(
    "/motors/{name}/inspections/{inspection_id}/pictures",
    status_code=HTTPStatus.CREATED,
    responses=problems(404, 409, 413, 415),
    dependencies=[require(Permission.NOTE)],
)
def add_inspection_picture(
    context: Context,
    name: Name,
    inspection_id: UUID,
    caller: By,
    picture: Annotated[
        bytes,
        Body(
            media_type=PICTURE_TYPE,
            min_length=1,
            max_length=MAX_PICTURE_BYTES,
            description="A PNG or JPEG, known by its content.",
        ),
    ],
) -> Inspection:
    """Keep a picture of an inspection, which has at most four."""
    kept = context.repository.add_inspection_picture(
        name, str(inspection_id), picture_of(picture, "body"), by=caller, now_ns=time.time_ns()
    )
    return Inspection.model_validate(kept)


@router.get(
    "/motors/{name}/inspections/{inspection_id}/pictures/{number}",
    responses=problems(404) | _PICTURE,
    response_class=Response,
    dependencies=[require(Permission.VIEW)],
)
def get_inspection_picture(
    context: Context, name: Name, inspection_id: UUID, number: Annotated[int, Path(ge=1, le=1000)]
) -> Response:
    """Return a picture of an inspection."""
    return picture_answer(context.repository.inspection_picture(name, str(inspection_id), number))


@router.post(
    "/motors/{name}/inspections/{inspection_id}/withdrawal",
    responses=problems(400, 404, 409, 413),
    dependencies=[require(Permission.CONFIGURE)],
)
def withdraw_inspection(
    context: Context, name: Name, inspection_id: UUID, wanted: InspectionWithdrawal, caller: By
) -> Inspection:
    """Let an inspection that was wrong count no more."""
    kept = context.repository.withdraw_inspection(
        name, str(inspection_id), by=caller, reason=wanted.reason, now_ns=time.time_ns()
    )
    return Inspection.model_validate(kept)


@router.get("/inspections/figures", responses=problems(), dependencies=[require(Permission.VIEW)])
def get_inspection_figures(context: Context) -> InspectionCounts:
    """Return how often inspections found what was said, by kind of finding, site and year."""
    counts = context.repository.inspection_counts()
    return InspectionCounts(counts=[InspectionCount.model_validate(one) for one in counts])


def keep_inspection(
    context: ApiContext,
    motor: str,
    wanted: InspectionRequest,
    pictures: tuple[InspectionPicture, ...],
    by: Actor,
) -> Inspection:
    """Keep what an inspection found, beside what is said of the motor now where nobody tells what was said.

    Raises NotFoundError, OutOfServiceError, ProblemError, TooManyInspectionsError.
    """
    now_ns = time.time_ns()
    time_ns = now_ns if wanted.time is None else wanted.time
    if not 0 <= time_ns <= now_ns + FURTHEST_AHEAD_NS:
        raise WrongFieldError(
            "body.time", f"expected a time after 1970 and not ahead, found {rfc3339(time_ns)}"
        )
    entry = context.repository.condition(motor)
    kind = entry.kind if wanted.kind is None else wanted.kind
    if kind is Kind.NONE and wanted.outcome is InspectionOutcome.CONFIRMED:
        raise WrongFieldError(
            "body.outcome",
            "nothing was said of this motor that could be confirmed: name the kind that was said, or tell "
            "what was found as other-cause",
        )
    if (wanted.outcome is InspectionOutcome.OTHER_CAUSE) != (wanted.cause is not None):
        raise WrongFieldError(
            "body.cause", "expected what it was with the outcome other-cause, and with no other one"
        )
    said = str((entry.document or {}).get("finding", "")) if kind is entry.kind else kind.value
    kept = context.repository.add_inspection(
        motor,
        NewInspection(
            time_ns, kind, one_line(said), wanted.outcome, wanted.text, wanted.cause, wanted.alarm_id
        ),
        pictures,
        by=by,
        on_behalf_of=wanted.on_behalf_of,
        now_ns=now_ns,
    )
    return Inspection.model_validate(kept)
