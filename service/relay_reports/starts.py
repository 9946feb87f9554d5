"""Motor start reports (MSR): their starts become starts of the motor."""

from collections.abc import Sequence
from dataclasses import dataclass

from core.machines.parameters import Motor
from core.relay_reports import StartReport, read_motor_starts
from core.starts.errors import NoStartError
from core.starts.reported import reported_start
from service.relay_reports.brought import LATER, BroughtReport
from service.relay_reports.errors import RefusedReportError
from service.relay_reports.kept import KeptStarts, LeftOutStart
from service.storage import Repository
from service.storage.records import ReportedStart


@dataclass(frozen=True, slots=True)
class _Starts:
    """Starts of a report that can be kept, and why others cannot, each with its time."""

    starts: Sequence[ReportedStart]
    left_out: Sequence[LeftOutStart]


def keep_starts(repository: Repository, motor: Motor, brought: BroughtReport) -> KeptStarts:
    """Keep the starts of a report. One that is recorded, too, is joined with its recording.

    Raises ReportError, RefusedReportError where no start of a report has any figures.
    """
    frequency_Hz = motor.nameplate.rated_frequency_Hz
    reports = read_motor_starts(brought.text, date_order=brought.date_order, frequency_Hz=frequency_Hz)
    found = _measured(motor, reports, brought)
    imported = repository.add_reported_starts(motor.name, found.starts, by=brought.by, now_ns=brought.now_ns)
    return KeptStarts(imported, found.left_out)


def _measured(motor: Motor, reports: Sequence[StartReport], brought: BroughtReport) -> _Starts:
    starts, left_out = [], []
    for report in reports:
        time_ns = brought.utc_ns(report.time_ns)
        try:
            examined = reported_start(report, motor)
        except NoStartError as error:
            left_out.append(LeftOutStart(time_ns, str(error)))
            continue
        if brought.is_ahead(time_ns):
            left_out.append(LeftOutStart(time_ns, LATER))
            continue
        starts.append(ReportedStart(time_ns, examined))
    if reports and not starts:
        message = f"none of {len(reports)} starts can be kept; of the first: {left_out[0].reason}"
        raise RefusedReportError("", message)
    return _Starts(starts, left_out)
