"""What a mail with a report says, and the report itself."""

from collections.abc import Mapping

from core.time_stamps import rfc3339
from service.configuration.notifications import NotificationSettings
from service.notifications.messages.content import Content, Section
from service.reports.document import Facts, ReportDocument
from service.reports.errors import ReportRequestError
from service.reports.making import ReportFile, document_of, file_of
from service.reports.source import ReportSource
from service.reports.wanted import AlarmsReport, FleetReport, MotorReport, ReportFormat, WantedReport
from service.senders.message import Attachment, Line
from service.storage import NotFoundError
from service.storage.records import Notification

LARGEST_BYTES = 15 << 20
"""Mail servers take no more than 20 MB or so, and a mail writes four bytes for three."""

TOO_LARGE = "The report is too large for a mail: its page and `mcc report` have it."
GONE = "The report could not be made: {}. The table [reports] of the settings asks for it."


def report_content(
    notification: Notification, settings: NotificationSettings, source: ReportSource
) -> Content:
    """Return what is said, with the report. Raises ReportError, SQLAlchemyError.

    A report of what the plant does not have any more is told in words: another attempt would not find it.
    """
    told = notification.document or {}
    try:
        wanted = _wanted(told)
        document = document_of(source, wanted)
        file = file_of(document, wanted, ReportFormat(str(told["format"])))
    except (ReportRequestError, NotFoundError) as error:
        subject = "StatorWatch: a report could not be made"
        return _content(notification, subject, Section(GONE.format(error), "info"), ())
    section = Section(document.subject, "info", _facts(document), _links(settings.address))
    if len(file.content) > LARGEST_BYTES:
        section = Section(TOO_LARGE, "info", section.facts, section.links)
        return _content(notification, f"StatorWatch: {document.title}", section, ())
    return _content(notification, f"StatorWatch: {document.title}", section, (_attachment(file),))


def _content(
    notification: Notification, subject: str, section: Section, attachments: tuple[Attachment, ...]
) -> Content:
    document = {
        "id": notification.id,
        "type": "report",
        "time": rfc3339(notification.created_ns),
        "subject": subject,
        "severity": "info",
    }
    return Content(
        subject=subject,
        severity="info",
        intro="",
        sections=[section],
        document=document,
        lines=[Line(subject, "info", {"report": str((notification.document or {}).get("report", ""))})],
        attachments=attachments,
    )


def _wanted(told: Mapping[str, object]) -> WantedReport:
    until_ns, sites = told["until_ns"], told.get("sites")
    chosen = [str(site) for site in sites] if isinstance(sites, list) else None
    if not isinstance(until_ns, int):
        raise ReportRequestError("until", "expected a time")
    match told["report"]:
        case "fleet":
            return FleetReport("weekly" if told["period"] == "weekly" else "daily", until_ns, chosen)
        case "motor":
            return MotorReport(str(told["motor"]), until_ns)
        case _:
            return AlarmsReport(str(told["month"]), until_ns, chosen)


def _facts(document: ReportDocument) -> list[tuple[str, str]]:
    """Return the first facts of a report, which are its summary."""
    contents = (one for block in document.blocks for one in block.contents)
    return next((list(one.facts) for one in contents if isinstance(one, Facts)), [])


def _links(address: str | None) -> list[tuple[str, str]]:
    return [] if address is None else [("reports", f"{address}/reports")]


def _attachment(file: ReportFile) -> Attachment:
    return Attachment(file.name, file.format.media_type, file.content)
