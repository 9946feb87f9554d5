"""Text reports of a motor's relay, which people bring: one way in for all kinds."""

import time
from http import HTTPStatus
from typing import Annotated, Final
from zoneinfo import ZoneInfo

from fastapi import APIRouter, Body, Query

from core.relay_reports import ReportError, ReportKind, kind_of_report
from core.relay_reports.clock_times import DateOrder
from service.access.permissions import Permission
from service.api.access.callers import By
from service.api.access.requirements import require
from service.api.context import Context
from service.api.document import Name
from service.api.limits.body_limits import MAX_REPORT_BYTES, REPORT_TYPE
from service.api.problems import ProblemError, problems
from service.api.relay_reports.brought import BroughtReport
from service.api.relay_reports.errors import unreadable
from service.api.relay_reports.events import keep_events
from service.api.relay_reports.load_profile import PowerUnit, keep_load_profile
from service.api.relay_reports.schemas import ReportImport
from service.api.relay_reports.starts import keep_starts
from service.api.relay_reports.statistics import keep_statistics

router = APIRouter(prefix="/motors/{name}", tags=["motors"])

REPORT_ROUTES: Final = frozenset({("POST", "/motors/{name}/reports")})
"""Routes that take a relay's report as text."""

OrderOfDates = Annotated[DateOrder, Query(description="Order of its dates: the relay's setting DATE_F.")]
UnitOfPower = Annotated[
    PowerUnit | None, Query(description="Unit of P and Q in a load profile; without it they are left out.")
]


@router.post(
    "/reports",
    responses=problems(404, 409, 413, 415),
    dependencies=[require(Permission.RECORDINGS)],
)
def import_report(
    context: Context,
    name: Name,
    caller: By,
    report: Annotated[
        bytes,
        Body(
            media_type=REPORT_TYPE,
            min_length=1,
            max_length=MAX_REPORT_BYTES,
            description="A report (MSR, LDP, MOT, SER), as the relay sends it or as a terminal showed it.",
        ),
    ],
    date_order: OrderOfDates = DateOrder.MDY,
    power_unit: UnitOfPower = None,
) -> ReportImport:
    """Keep what a text report of a motor's relay tells: starts, load, statistics, events."""
    context.require_motor(name)
    motor = context.motors.get(name)
    if motor is None:
        reason = f"motor {name} is not in the plant's files: its parameters are unknown"
        raise ProblemError(HTTPStatus.CONFLICT, reason)
    zone = ZoneInfo(context.time_zones.get(name, "UTC"))
    brought = BroughtReport(report, date_order, zone, by=caller, now_ns=time.time_ns())
    repository = context.repository
    try:
        kind = kind_of_report(report)
        match kind:
            case ReportKind.MOTOR_STARTS:
                return ReportImport(kind=kind, motor_starts=keep_starts(repository, motor, brought))
            case ReportKind.LOAD_PROFILE:
                rows = keep_load_profile(repository, name, brought, power_unit)
                return ReportImport(kind=kind, load_profile=rows)
            case ReportKind.MOTOR_STATISTICS:
                return ReportImport(kind=kind, motor_statistics=keep_statistics(repository, name, brought))
            case ReportKind.SEQUENCE_OF_EVENTS:
                return ReportImport(kind=kind, events=keep_events(repository, name, brought))
    except ReportError as error:
        raise unreadable(error) from error
