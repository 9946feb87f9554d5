"""Motor start reports that people bring: their starts become starts of the motor."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from http import HTTPStatus
from typing import Annotated, Final
from zoneinfo import ZoneInfo

from fastapi import APIRouter, Body, Query

from core.machines.parameters import Motor
from core.recordings.local_time import utc_of
from core.relay_reports import ReportError, StartReport, other_report, read_motor_starts
from core.relay_reports.clock_times import DateOrder
from core.starts.errors import NoStartError
from core.starts.reported import reported_start
from core.units import NANOSECONDS_PER_DAY
from service.access.permissions import Permission
from service.api.access.callers import By
from service.api.access.requirements import require
from service.api.context import ApiContext, Context
from service.api.document import Name
from service.api.limits.body_limits import MAX_REPORT_BYTES, REPORT_TYPE
from service.api.problems import FieldError, ProblemError, problems
from service.api.starts.schemas import LeftOutStart, StartImport
from service.storage.records import ReportedStart

router = APIRouter(prefix="/motors/{name}/starts", tags=["motors"])

REPORT_ROUTES: Final = frozenset({("POST", "/motors/{name}/starts/reports")})
"""Routes that take a relay's report as text."""
AHEAD_NS: Final = NANOSECONDS_PER_DAY
"""No relay's clock is so far ahead of the time; a date that is was read in the wrong order."""

OrderOfDates = Annotated[DateOrder, Query(description="Order of its dates: the relay's setting DATE_F.")]


@dataclass(frozen=True, slots=True)
class ReadStarts:
    """Starts of a report that can be kept, and why others cannot, each with the time of the relay's clock."""

    starts: Sequence[ReportedStart]
    left_out: Sequence[LeftOutStart]


@router.post(
    "/reports",
    responses=problems(404, 409, 413, 415),
    dependencies=[require(Permission.RECORDINGS)],
)
def import_starts(
    context: Context,
    name: Name,
    caller: By,
    report: Annotated[
        bytes,
        Body(
            media_type=REPORT_TYPE,
            min_length=1,
            max_length=MAX_REPORT_BYTES,
            description="A motor start report (MSR), as the relay sends it or as a terminal showed it.",
        ),
    ],
    date_order: OrderOfDates = DateOrder.MDY,
) -> StartImport:
    """Keep the starts of a motor start report. One that is recorded, too, is joined with its recording."""
    context.require_motor(name)
    motor = context.motors.get(name)
    if motor is None:
        reason = f"motor {name} is not in the plant's files: its parameters are unknown"
        raise ProblemError(HTTPStatus.CONFLICT, reason)
    now_ns = time.time_ns()
    found = _measured(context, motor, _read(report, motor, date_order), now_ns)
    imported = context.repository.add_reported_starts(name, found.starts, by=caller, now_ns=now_ns)
    return StartImport.model_validate({"starts": imported, "left_out": found.left_out})


def _read(report: bytes, motor: Motor, date_order: DateOrder) -> Sequence[StartReport]:
    """Return the starts of a report. Raises ProblemError that names line and field."""
    frequency_Hz = motor.nameplate.rated_frequency_Hz
    try:
        return read_motor_starts(report, date_order=date_order, frequency_Hz=frequency_Hz)
    except ReportError as error:
        other = other_report(report, date_order=date_order)
        if other is not None:
            message = f"expected a motor start report (MSR), found {other}; the service does not take it"
            raise _refused("body", message) from error
        message = f"expected {error.expected}, found {error.found}"
        raise _refused(f"body: {error.place}", message) from error


def _measured(context: ApiContext, motor: Motor, reports: Sequence[StartReport], now_ns: int) -> ReadStarts:
    """Return the starts in UTC with their figures. Raises ProblemError where no start of a report has any."""
    zone = ZoneInfo(context.time_zones.get(motor.name, "UTC"))
    starts, left_out = [], []
    for report in reports:
        time_ns = utc_of(report.time_ns, zone).ns
        try:
            examined = reported_start(report, motor)
        except NoStartError as error:
            left_out.append(_left_out(time_ns, str(error)))
            continue
        if time_ns > now_ns + AHEAD_NS:
            reason = "expected a time that has been, found a later one: see date_order, and the relay's clock"
            left_out.append(_left_out(time_ns, reason))
            continue
        starts.append(ReportedStart(time_ns, examined))
    if reports and not starts:
        message = f"none of {len(reports)} starts can be kept; of the first: {left_out[0].reason}"
        raise _refused("body", message)
    return ReadStarts(starts, left_out)


def _left_out(time_ns: int, reason: str) -> LeftOutStart:
    return LeftOutStart.model_validate({"time": time_ns, "reason": reason})


def _refused(location: str, message: str) -> ProblemError:
    return ProblemError(
        HTTPStatus.UNPROCESSABLE_ENTITY,
        f"{location}: {message}",
        errors=[FieldError(location=location, message=message)],
    )
