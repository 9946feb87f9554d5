"""What every way in of people does with a relay's text report: keep it, or answer what is wrong with it."""

from http import HTTPStatus
from zoneinfo import ZoneInfo

from core.relay_reports.clock_times import DateOrder
from service.api.context import ApiContext
from service.api.problems import FieldError, ProblemError
from service.api.relay_reports.schemas import ReportImport
from service.plant import PowerUnit
from service.relay_reports.brought import BroughtReport
from service.relay_reports.errors import RefusedReportError
from service.relay_reports.keeping import keep_report
from service.storage.records import Actor


def keep_brought(
    context: ApiContext,
    name: str,
    text: bytes,
    *,
    date_order: DateOrder,
    power_unit: PowerUnit | None,
    by: Actor,
    now_ns: int,
) -> ReportImport:
    """Keep what a text report of a motor's relay tells. Raises NotFoundError, ProblemError."""
    context.require_motor(name)
    motor = context.motors.get(name)
    if motor is None:
        reason = f"motor {name} is not in the plant's files: its parameters are unknown"
        raise ProblemError(HTTPStatus.CONFLICT, reason)
    zone = ZoneInfo(context.time_zones.get(name, "UTC"))
    brought = BroughtReport(text, date_order, power_unit, zone, by=by, now_ns=now_ns)
    try:
        kept = keep_report(context.repository, motor, brought)
    except RefusedReportError as error:
        raise _refused(error) from error
    return ReportImport.model_validate(kept)


def _refused(error: RefusedReportError) -> ProblemError:
    """Return the answer to a report that cannot be kept: what is wrong, in which line and field."""
    location = f"body: {error.place}" if error.place else "body"
    return ProblemError(
        HTTPStatus.UNPROCESSABLE_ENTITY,
        f"{location}: {error.message}",
        errors=[FieldError(location=location, message=error.message)],
    )
