"""Reports by mail: which are due, and each made when its message is sent."""

from collections.abc import Iterator, Mapping
from datetime import datetime

from core.units import NANOSECONDS_PER_SECOND
from service.configuration.reports import ReportMail
from service.configuration.settings import Settings
from service.notifications.due import due_now
from service.reports.times import month_at, month_before
from service.senders.sending import recipients
from service.storage import Repository
from service.storage.records import NewNotification
from service.storage.states import NotificationKind


def due_reports(settings: Settings, repository: Repository, now_ns: int) -> Iterator[NewNotification]:
    """Yield the messages of the reports that are due and not made yet. Raises SQLAlchemyError."""
    zone = settings.notifications.time_zone
    for mail, due in due_now(settings.reports.mails, zone, repository, now_ns):
        for document in _documents(mail, due, zone):
            for channel in mail.channels:
                for recipient in recipients(settings.notifications.channels[channel]):
                    key = _key(document, due, channel, recipient)
                    if not repository.is_known_notification(key):
                        yield NewNotification(NotificationKind.REPORT, channel, recipient, document, key)


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
