"""From a wanted report to its file."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from core.error_words import nearest, shown
from core.time_words import clock, day
from service.reports.contents.alarms import alarms_document
from service.reports.contents.fleet import fleet_document
from service.reports.contents.motor import motor_document
from service.reports.document import ReportDocument
from service.reports.errors import ReportRequestError
from service.reports.source import ReportSource
from service.reports.times import Period, month_of, period_until
from service.reports.typesetting.pdf import pdf
from service.reports.wanted import AlarmsReport, FleetReport, MotorReport, ReportFormat, WantedReport
from service.reports.workbook import workbook

MOST_SITES = 500
_UNSAFE = re.compile(r"[^A-Za-z0-9-]+")


@dataclass(frozen=True, slots=True)
class ReportFile:
    """A report that is made. name: of its file, in characters that every system takes."""

    name: str
    title: str
    format: ReportFormat
    content: bytes


def make_report(source: ReportSource, wanted: WantedReport, wanted_format: ReportFormat) -> ReportFile:
    """Return the file of a report.

    Raises ReportRequestError, ReportError, NotFoundError for a motor that there is not, SQLAlchemyError.
    """
    return file_of(document_of(source, wanted), wanted, wanted_format)


def document_of(source: ReportSource, wanted: WantedReport) -> ReportDocument:
    """Return what a report says.

    Raises ReportRequestError, NotFoundError for a motor that there is not, SQLAlchemyError.
    """
    zone = source.time_zone
    match wanted:
        case FleetReport(days, until_ns, sites):
            _require_sites(source, sites)
            title = f"Fleet, {days} report of {day(until_ns, zone)}"
            return fleet_document(source, period_until(days, until_ns, zone), title, sites)
        case MotorReport(motor, until_ns):
            return motor_document(source, motor, until_ns)
        case AlarmsReport(month, until_ns, sites):
            _require_sites(source, sites)
            whole = month_of(month, zone)
            if whole.from_ns >= until_ns:
                raise ReportRequestError("month", f"{month} has not begun")
            return alarms_document(source, Period(whole.from_ns, min(whole.to_ns, until_ns)), month, sites)


def file_of(document: ReportDocument, wanted: WantedReport, wanted_format: ReportFormat) -> ReportFile:
    """Return the file of what a report says. Raises ReportError."""
    content = pdf(document) if wanted_format is ReportFormat.PDF else workbook(document)
    name = f"{_stem(wanted, document.time_zone)}.{wanted_format}"
    return ReportFile(name, document.title, wanted_format, content)


def _require_sites(source: ReportSource, sites: Sequence[str] | None) -> None:
    """Raise ReportRequestError for a site that there is not."""
    if sites is None:
        return
    known = {site.name for site in source.repository.sites(limit=MOST_SITES).items}
    for site in sites:
        if site not in known:
            near = nearest(site, known)
            meant = "" if near is None else f" (did you mean {near}?)"
            raise ReportRequestError("site", f"there is no site {shown(site)}{meant}")


def _stem(wanted: WantedReport, zone: str) -> str:
    match wanted:
        case FleetReport(period, until_ns, _):
            return f"fleet_{period}_{_stamp(until_ns, zone)}"
        case MotorReport(motor, until_ns):
            return f"motor_{_UNSAFE.sub('_', motor)[:80]}_{_stamp(until_ns, zone)}"
        case AlarmsReport(month, _, _):
            return f"alarms_{month}"


def _stamp(time_ns: int, zone: str) -> str:
    return _UNSAFE.sub("-", clock(time_ns, zone)[:16])
