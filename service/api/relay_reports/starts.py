"""Motor start reports (MSR): their starts become starts of the motor."""

from collections.abc import Sequence
from dataclasses import dataclass

from core.machines.parameters import Motor
from core.relay_reports import StartReport, read_motor_starts
from core.relay_reports.clock_times import DateOrder
from core.starts.errors import NoStartError
from core.starts.reported import reported_start
from service.api.relay_reports.clocks import LATER, RelayClock
from service.api.relay_reports.errors import refused
from service.api.relay_reports.schemas import LeftOutStart, StartImport
from service.storage import Repository
from service.storage.records import Actor, ReportedStart


@dataclass(frozen=True, slots=True)
class _Starts:
    """Starts of a report that can be kept, and why others cannot, each with its time."""

    starts: Sequence[ReportedStart]
    left_out: Sequence[LeftOutStart]


def keep_starts(
    repository: Repository,
    motor: Motor,
    report: bytes,
    date_order: DateOrder,
    clock: RelayClock,
    *,
    by: Actor,
    now_ns: int,
) -> StartImport:
    """Keep the starts of a report. One that is recorded, too, is joined with its recording.

    Raises ReportError, ProblemError where no start of a report has any figures.
    """
    frequency_Hz = motor.nameplate.rated_frequency_Hz
    reports = read_motor_starts(report, date_order=date_order, frequency_Hz=frequency_Hz)
    found = _measured(motor, reports, clock)
    imported = repository.add_reported_starts(motor.name, found.starts, by=by, now_ns=now_ns)
    return StartImport.model_validate({"starts": imported, "left_out": found.left_out})


def _measured(motor: Motor, reports: Sequence[StartReport], clock: RelayClock) -> _Starts:
    starts, left_out = [], []
    for report in reports:
        time_ns = clock.utc_ns(report.time_ns)
        try:
            examined = reported_start(report, motor)
        except NoStartError as error:
            left_out.append(_left_out(time_ns, str(error)))
            continue
        if clock.is_ahead(time_ns):
            left_out.append(_left_out(time_ns, LATER))
            continue
        starts.append(ReportedStart(time_ns, examined))
    if reports and not starts:
        message = f"none of {len(reports)} starts can be kept; of the first: {left_out[0].reason}"
        raise refused("body", message)
    return _Starts(starts, left_out)


def _left_out(time_ns: int, reason: str) -> LeftOutStart:
    return LeftOutStart.model_validate({"time": time_ns, "reason": reason})
