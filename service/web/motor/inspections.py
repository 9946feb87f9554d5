"""What people found at a motor: the form on its page, with pictures."""

from typing import Annotated, Final
from uuid import UUID

from fastapi import APIRouter, File, Form, UploadFile
from starlette.responses import Response

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.document import Name
from service.api.inspections.pictures import MAX_PICTURE_BYTES, picture_of
from service.api.inspections.routes import keep_inspection
from service.api.inspections.schemas import InspectionRequest, InspectionWithdrawal
from service.api.limits.body_limits import UPLOAD_TYPE, BodyRule
from service.api.recordings.routes import FormLimits
from service.storage.repository.inspections import MOST_PICTURES
from service.web.forms import document_of_form
from service.web.motor.page import LOGBOOK, tab_address
from service.web.motor.routes import utc
from service.web.view import Looking

router = APIRouter()

BODIES: Final = {
    ("POST", "/motors/{name}/inspections"): BodyRule(
        UPLOAD_TYPE, MOST_PICTURES * MAX_PICTURE_BYTES + 64 * 1024
    )
}
"""Pictures come with the form."""
FORM_LIMITS: Final[FormLimits] = {"max_files": MOST_PICTURES, "max_fields": 8, "max_part_size": 8192}

Field = Annotated[str, Form(max_length=2000)]


@router.post("/motors/{name}/inspections", dependencies=[require(Permission.NOTE)], form_limits=FORM_LIMITS)
def tell_inspection(
    view: Looking,
    name: Name,
    outcome: Field,
    text: Field = "",
    kind: Field = "",
    cause: Field = "",
    alarm: Field = "",
    time: Field = "",
    pictures: Annotated[list[UploadFile] | None, File()] = None,
) -> Response:
    """Keep what an inspection found."""
    said = {
        "outcome": outcome,
        "text": text,
        "kind": kind,
        "cause": cause,
        "alarm_id": alarm,
        "time": utc(time),
    }
    wanted = document_of_form(InspectionRequest, said)
    contents = [one.file.read() for one in pictures or ()]
    given = tuple(picture_of(one, "body.pictures") for one in contents if one)
    keep_inspection(view.context, name, wanted, given, view.asking.actor)
    return view.done(tab_address(name, LOGBOOK), "inspection-kept")


@router.post(
    "/motors/{name}/inspections/{inspection_id}/withdrawal", dependencies=[require(Permission.CONFIGURE)]
)
def withdraw_inspection(view: Looking, name: Name, inspection_id: UUID, reason: Field = "") -> Response:
    """Let an inspection that was wrong count no more."""
    wanted = document_of_form(InspectionWithdrawal, {"reason": reason})
    view.context.repository.withdraw_inspection(
        name, str(inspection_id), by=view.asking.actor, reason=wanted.reason, now_ns=view.now_ns
    )
    return view.done(tab_address(name, LOGBOOK), "inspection-withdrawn")
