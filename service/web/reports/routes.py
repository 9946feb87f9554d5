"""The page from which reports are fetched. The files are those of the API's routes."""

from collections.abc import Sequence
from typing import Annotated, Final

from fastapi import APIRouter, Query
from starlette.responses import Response

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.reports.answers import TURN, report_answer, until
from service.reports.times import FleetPeriod, month_at, month_before
from service.reports.wanted import AlarmsReport, FleetReport, MotorReport, ReportFormat
from service.web.choices import motor_names, site_names
from service.web.view import Looking

router = APIRouter()

MONTHS: Final = 24
"""So many of the latest months can be chosen; the API takes any."""

VIEW = [require(Permission.VIEW)]
FILE = [require(Permission.VIEW), TURN]

Format = Annotated[ReportFormat, Query(alias="format")]
Site = Annotated[str | None, Query(max_length=200)]


@router.get("/reports", dependencies=VIEW)
def show_reports(view: Looking) -> Response:
    """Show which reports there are, and who is sent which."""
    settings = view.context.settings
    return view.page(
        "reports/page.html",
        title="Reports",
        motors=motor_names(view.context.repository),
        sites=site_names(view.context.repository),
        months=_months(view.now_ns, settings.notifications.time_zone),
        time_zone=settings.notifications.time_zone,
        mails=settings.reports.mails,
        inspections=view.context.repository.inspection_counts(),
    )


@router.get("/reports/fleet", dependencies=FILE)
def get_fleet_report(
    view: Looking, period: FleetPeriod = "daily", site: Site = None, format_: Format = ReportFormat.PDF
) -> Response:
    """Return the report of the fleet as a file."""
    wanted = FleetReport(period, until(None), [site] if site else None)
    return report_answer(view.context, wanted, format_)


@router.get("/reports/motor", dependencies=FILE)
def get_motor_report(
    view: Looking, motor: Annotated[str, Query(max_length=200)], format_: Format = ReportFormat.PDF
) -> Response:
    """Return the report of a motor as a file."""
    return report_answer(view.context, MotorReport(motor, until(None)), format_)


@router.get("/reports/alarms", dependencies=FILE)
def get_alarms_report(
    view: Looking,
    month: Annotated[str, Query(max_length=40)],
    site: Site = None,
    format_: Format = ReportFormat.PDF,
) -> Response:
    """Return the report of all alarms of a month as a file."""
    wanted = AlarmsReport(month, until(None), [site] if site else None)
    return report_answer(view.context, wanted, format_)


def _months(now_ns: int, zone: str) -> Sequence[str]:
    """Return the latest months, such as 2026-11, latest first."""
    found = [month_at(now_ns, zone)]
    for _ in range(MONTHS - 1):
        found.append(month_before(found[-1]))
    return found
