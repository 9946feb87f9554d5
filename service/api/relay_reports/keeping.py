"""What every way in does with a relay's text report: find its kind, and keep what it tells."""

from http import HTTPStatus
from zoneinfo import ZoneInfo

from core.relay_reports import ReportError, ReportKind, kind_of_report
from core.relay_reports.clock_times import DateOrder
from service.api.context import ApiContext
from service.api.problems import ProblemError
from service.api.relay_reports.brought import BroughtReport
from service.api.relay_reports.errors import unreadable
from service.api.relay_reports.events import keep_events
from service.api.relay_reports.load_profile import PowerUnit, keep_load_profile
from service.api.relay_reports.schemas import ReportImport
from service.api.relay_reports.starts import keep_starts
from service.api.relay_reports.statistics import keep_statistics
from service.storage.records import Actor


def keep_report(
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
    brought = BroughtReport(text, date_order, zone, by=by, now_ns=now_ns)
    repository = context.repository
    try:
        kind = kind_of_report(text)
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
