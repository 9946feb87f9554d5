"""Reports by mail: which are due, and each made when its message is sent."""

from collections.abc import Iterator, Mapping
from datetime import datetime, timedelta

from core.units import NANOSECONDS_PER_SECOND
from service.configuration.notifications import DAYS
from service.configuration.reports import ReportMail
from service.configuration.settings import Settings
from service.notifications.hours import local
from service.reports.times import month_at, month_before
from service.senders.sending import recipients
from service.storage import Repository
from service.storage.records import NewNotification
from service.storage.states import NotificationKind

LATEST = timedelta(hours=12)
"""A report that no service could send in time is made up for within this time."""

LOOKED_BACK_DAYS = 32


def due_reports(settings: Settings, repository: Repository, now_ns: int) -> Iterator[NewNotification]:
    """Yield the messages of the reports that are due and not made yet. Raises SQLAlchemyError.

    None of a time before the service first started, which the audit trail begins with.
    """
    mails = settings.reports.mails
    at = local(now_ns, settings.notifications.time_zone)
    latest = [(mail, due) for mail in mails if at - (due := latest_due(mail, at)) <= LATEST]
    began_ns = repository.first_audit_entry_ns() if latest else None
    for mail, due in latest:
        if began_ns is not None and due.timestamp() * NANOSECONDS_PER_SECOND < began_ns:
            continue
        for document in _documents(mail, due, settings.notifications.time_zone):
            for channel in mail.channels:
                for recipient in recipients(settings.notifications.channels[channel]):
                    key = _key(document, due, channel, recipient)
                    if not repository.is_known_notification(key):
                        yield NewNotification(NotificationKind.REPORT, channel, recipient, document, key)


def latest_due(mail: ReportMail, at: datetime) -> datetime:
    """Return when a mail was due last, at a local time or before."""
    for ago in range(LOOKED_BACK_DAYS):
        due = datetime.combine(at.date() - timedelta(days=ago), mail.at, at.tzinfo)
        is_its_day = {
            "daily": True,
            "weekly": DAYS[due.weekday()] == mail.day,
            "monthly": due.day == 1,
        }[mail.period]
        if due <= at and is_its_day:
            return due
    raise AssertionError("a report is due every month")


def _documents(mail: ReportMail, due: datetime, zone: str) -> Iterator[Mapping[str, object]]:
    """Yield what tells each report of a mail: it is of the due time, whenever it is sent."""
    until_ns = round(due.timestamp()) * NANOSECONDS_PER_SECOND
    said = {"report": mail.report, "period": mail.period, "format": mail.format, "until_ns": until_ns}
    if mail.motors is not None:
        for motor in mail.motors:
            yield {**said, "motor": motor}
        return
    sites = None if mail.sites is None else sorted(mail.sites)
    month = {"month": month_before(month_at(until_ns, zone))} if mail.report == "alarms" else {}
    yield {**said, **month, "sites": sites}


def _key(document: Mapping[str, object], due: datetime, channel: str, recipient: str) -> str:
    """Return what tells a mail from all others, whatever else changes in the settings."""
    sites = document.get("sites")
    of = document.get("motor") or (",".join(map(str, sites)) if isinstance(sites, list) else "")
    words = (document["period"], document["report"], document["format"])
    return f"{' '.join(map(str, words))} {due:%Y-%m-%d %H:%M} {of} {channel} {recipient}"
