"""Reports of the fleet, of a motor and of the alarms of a month."""

from typing import Annotated

from fastapi import APIRouter, Query, Response

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.context import Context
from service.api.document import Name
from service.api.reports.answers import FILES, TURN, Format, Sites, report_answer, until
from service.api.times import TimeParameter
from service.reports.times import FleetPeriod, month_at
from service.reports.wanted import AlarmsReport, FleetReport, MotorReport, ReportFormat

router = APIRouter(
    prefix="/reports",
    tags=["reports"],
    dependencies=[require(Permission.VIEW), TURN],
    responses=FILES,
    default_response_class=Response,
)

Until = Annotated[
    TimeParameter | None, Query(alias="until", description="Nothing later is told; without: now.")
]
Month = Annotated[
    str | None,
    Query(max_length=40, description="Such as 2026-11, in the time zone of the settings; without: this one."),
]


@router.get("/fleet")
def get_fleet_report(
    context: Context,
    period: FleetPeriod = "daily",
    until_: Until = None,
    site: Sites = None,
    format_: Format = ReportFormat.PDF,
) -> Response:
    """Return how all motors were at a time, and what happened in the day or week before."""
    return report_answer(context, FleetReport(period, until(until_), site), format_)


@router.get("/motors/{name}")
def get_motor_report(
    context: Context, name: Name, until_: Until = None, format_: Format = ReportFormat.PDF
) -> Response:
    """Return all of one motor until a time, with its pictures."""
    return report_answer(context, MotorReport(name, until(until_)), format_)


@router.get("/alarms")
def get_alarms_report(
    context: Context, month: Month = None, site: Sites = None, format_: Format = ReportFormat.PDF
) -> Response:
    """Return all calls of alarms in a month, and what became of each until the month's end or now."""
    until_ns = until(None)
    chosen = month or month_at(until_ns, context.settings.notifications.time_zone)
    return report_answer(context, AlarmsReport(chosen, until_ns, site), format_)
