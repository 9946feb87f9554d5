"""Text reports of a motor's relay that people bring: the form on the motor's page, and what became of one."""

from dataclasses import dataclass
from http import HTTPStatus
from typing import Annotated, Final, Literal

from fastapi import APIRouter, File, Form, UploadFile
from starlette.responses import Response

from core.relay_reports.clock_times import DateOrder
from core.time_stamps import nanoseconds
from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.document import Name
from service.api.limits.body_limits import REPORT_IN_FORM
from service.api.problems import ProblemError
from service.api.recordings.routes import FormLimits
from service.api.relay_reports.keeping import keep_brought
from service.api.relay_reports.schemas import ReportImport
from service.plant import PowerUnit
from service.web.view import Looking, View

router = APIRouter()

BODIES: Final = {("POST", "/motors/{name}/reports"): REPORT_IN_FORM}
"""Routes that take a relay's report in a form."""
FORM_LIMITS: Final[FormLimits] = {"max_files": 2, "max_fields": 4, "max_part_size": 100}


@dataclass(frozen=True, slots=True)
class BroughtFile:
    """What somebody brought, and what became of it: either it was kept, or it says why it was not."""

    name: str
    date_order: DateOrder
    power_unit: str
    kept: ReportImport | None = None
    refused: str | None = None


@router.post("/motors/{name}/reports", dependencies=[require(Permission.RECORDINGS)], form_limits=FORM_LIMITS)
def bring_report(
    view: Looking,
    name: Name,
    report: Annotated[UploadFile | None, File()] = None,
    date_order: Annotated[DateOrder, Form()] = DateOrder.MDY,
    power_unit: Annotated[Literal["", "W", "kW"], Form()] = "",
) -> Response:
    """Keep what a report tells, and say what that was. What is wrong with it stands beside its field."""
    view.context.require_motor(name)
    file_name = "" if report is None else (report.filename or "")[:100]
    text = b"" if report is None else report.file.read()
    if not text:
        why = "its file is empty" if file_name else "choose its file first"
        return _shown(view, name, BroughtFile(file_name, date_order, power_unit, refused=why))
    try:
        kept = keep_brought(
            view.context,
            name,
            text,
            date_order=date_order,
            power_unit=PowerUnit(power_unit) if power_unit else None,
            by=view.asking.actor,
            now_ns=view.now_ns,
        )
    except ProblemError as error:
        if error.errors is None:
            raise
        why = "; ".join(f"{_place(one.location)}{one.message}" for one in error.errors)
        return _shown(view, name, BroughtFile(file_name, date_order, power_unit, refused=why))
    return _shown(view, name, BroughtFile(file_name, date_order, power_unit, kept=kept))


def _place(location: str) -> str:
    """Return where in the report something is wrong: what the API calls `body` is the file here."""
    place = location.removeprefix("body").removeprefix(": ")
    return f"{place}: " if place else ""


def _shown(view: View, name: str, brought: BroughtFile) -> Response:
    return view.page(
        "motor/brought_report.html",
        status=HTTPStatus.OK if brought.refused is None else HTTPStatus.UNPROCESSABLE_ENTITY,
        title=f"{name}: a report of its relay",
        motor_name=name,
        brought=brought,
        nanoseconds=nanoseconds,
    )
