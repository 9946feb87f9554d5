"""Motor statistics (MOT): kept as they are, to stand beside what the service counts."""

from dataclasses import replace

from core.relay_reports import read_motor_statistics
from core.relay_reports.clock_times import DateOrder
from service.api.relay_reports.clocks import LATER, RelayClock
from service.api.relay_reports.errors import refused
from service.api.relay_reports.schemas import StatisticsImport
from service.storage import Repository
from service.storage.records import Actor


def keep_statistics(
    repository: Repository,
    motor: str,
    report: bytes,
    date_order: DateOrder,
    clock: RelayClock,
    *,
    by: Actor,
    now_ns: int,
) -> StatisticsImport:
    """Keep the statistics of a report. Raises ReportError, ProblemError."""
    told = read_motor_statistics(report, date_order=date_order)
    time_ns = clock.utc_ns(told.time_ns)
    since_ns = None if told.since_ns is None else clock.utc_ns(told.since_ns)
    if clock.is_ahead(time_ns):
        raise refused("body: Date", LATER)
    if since_ns is not None and since_ns > time_ns:
        raise refused("body: Since", "expected a time before that of the report, found a later one")
    there = replace(told, time_ns=time_ns, since_ns=since_ns)
    added = repository.add_relay_statistics(motor, there, by=by, now_ns=now_ns)
    return StatisticsImport.model_validate({"time": time_ns, "since_time": since_ns, "added": added})
