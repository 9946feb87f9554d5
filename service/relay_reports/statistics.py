"""Motor statistics (MOT): kept as they are, to stand beside what the service counts."""

from dataclasses import replace

from core.relay_reports import read_motor_statistics
from service.relay_reports.brought import LATER, BroughtReport
from service.relay_reports.errors import RefusedReportError
from service.relay_reports.kept import KeptStatistics
from service.storage import Repository


def keep_statistics(repository: Repository, motor: str, brought: BroughtReport) -> KeptStatistics:
    """Keep the statistics of a report. Raises ReportError, RefusedReportError."""
    told = read_motor_statistics(brought.text, date_order=brought.date_order)
    time_ns = brought.utc_ns(told.time_ns)
    since_ns = None if told.since_ns is None else brought.utc_ns(told.since_ns)
    if brought.is_ahead(time_ns):
        raise RefusedReportError("Date", LATER)
    if since_ns is not None and since_ns > time_ns:
        raise RefusedReportError("Since", "expected a time before that of the report, found a later one")
    there = replace(told, time_ns=time_ns, since_ns=since_ns)
    added = repository.add_relay_statistics(motor, there, by=brought.by, now_ns=brought.now_ns)
    return KeptStatistics(time_ns, since_ns, added)
