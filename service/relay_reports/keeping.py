"""What every way in does with a relay's text report: find its kind, and keep what it tells."""

from core.machines.parameters import Motor
from core.relay_reports import ReportError, ReportKind, kind_of_report
from service.relay_reports.brought import BroughtReport
from service.relay_reports.errors import unreadable
from service.relay_reports.events import keep_events
from service.relay_reports.kept import KeptReport
from service.relay_reports.load_profile import keep_load_profile
from service.relay_reports.starts import keep_starts
from service.relay_reports.statistics import keep_statistics
from service.storage import Repository


def keep_report(
    repository: Repository, motor: Motor, brought: BroughtReport, named: ReportKind | None = None
) -> KeptReport:
    """Keep what a text report of a motor's relay tells. Raises RefusedReportError, NotFoundError.

    named: its kind, where the name of its file tells it; None where its text has to.
    """
    try:
        kind = kind_of_report(brought.text) if named is None else named
        match kind:
            case ReportKind.MOTOR_STARTS:
                return KeptReport(kind, motor_starts=keep_starts(repository, motor, brought))
            case ReportKind.LOAD_PROFILE:
                return KeptReport(kind, load_profile=keep_load_profile(repository, motor.name, brought))
            case ReportKind.MOTOR_STATISTICS:
                return KeptReport(kind, motor_statistics=keep_statistics(repository, motor.name, brought))
            case ReportKind.SEQUENCE_OF_EVENTS:
                return KeptReport(kind, events=keep_events(repository, motor.name, brought))
    except ReportError as error:
        raise unreadable(error) from error
