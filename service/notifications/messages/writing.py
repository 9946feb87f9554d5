"""A stored message written out in all the forms that channels take, with the trends of its motors."""

from dataclasses import replace

import structlog

from core.condition.kinds import State
from core.time_words import with_clock_times
from service.configuration.notifications import NotificationSettings
from service.notifications.messages.alarm_content import alarm_content
from service.notifications.messages.content import Content
from service.notifications.messages.digest_content import digest_content, picture_key
from service.notifications.messages.html import html
from service.notifications.messages.plain_text import plain_text
from service.notifications.messages.report_content import report_content
from service.notifications.messages.told_alarm import told_alarms
from service.notifications.messages.trial_content import trial_content
from service.notifications.trends import trend_of
from service.reports.source import ReportSource
from service.senders.message import Message
from service.storage import Repository
from service.storage.records import Notification
from service.storage.states import NotificationKind

log = structlog.get_logger(__name__)

MOST_PICTURES = 3
CONDITION = "condition-"
"""Alarms of these kinds are about a motor's level, which a picture shows."""


def message_of(
    notification: Notification,
    settings: NotificationSettings,
    repository: Repository,
    *,
    stale_after_days: float | None = None,
    with_pictures: bool,
) -> Message:
    """Return what is sent. stale_after_days: as of reports. Raises ReportError, SQLAlchemyError."""
    if notification.kind is NotificationKind.REPORT:
        content = report_content(
            notification, settings, ReportSource(repository, settings.time_zone, stale_after_days)
        )
    else:
        content = _content(notification, settings, repository, with_pictures=with_pictures)
    content = _in_zone(content, settings.time_zone)
    return Message(
        id=notification.id,
        created_ns=notification.created_ns,
        severity=content.severity,
        subject=content.subject,
        text=plain_text(content),
        html=html(content),
        pictures=content.pictures,
        lines=tuple(content.lines),
        document=content.document,
        thread=content.thread,
        attachments=content.attachments,
    )


def _in_zone(content: Content, zone: str) -> Content:
    """Return what a message says, with times of a zone within the sentences of the service."""
    sections = [
        replace(one, facts=[(name, with_clock_times(words, zone)) for name, words in one.facts])
        for one in content.sections
    ]
    return replace(content, subject=with_clock_times(content.subject, zone), sections=sections)


def _content(
    notification: Notification,
    settings: NotificationSettings,
    repository: Repository,
    *,
    with_pictures: bool,
) -> Content:
    match notification.kind:
        case NotificationKind.TEST:
            return trial_content(notification, settings.time_zone)
        case NotificationKind.DIGEST:
            names = _motors_of_digest(notification)[:MOST_PICTURES] if with_pictures else []
            wanted = {picture_key(number): name for number, name in enumerate(names)}
            return digest_content(notification, settings, _pictures(wanted, settings, repository))
        case _:
            wanted = _motors_of_alarms(notification) if with_pictures else {}
            return alarm_content(notification, settings, _pictures(wanted, settings, repository))


def _motors_of_alarms(notification: Notification) -> dict[str, str]:
    """Return the motors whose trends are shown, by the alarms that are about them."""
    wanted: dict[str, str] = {}
    for alarm in told_alarms(notification.document or {}):
        is_of_condition = alarm.motor is not None and alarm.kind.startswith(CONDITION)
        if is_of_condition and alarm.motor not in wanted.values() and len(wanted) < MOST_PICTURES:
            wanted[alarm.id] = str(alarm.motor)
    return wanted


def _motors_of_digest(notification: Notification) -> list[str]:
    attention = (notification.document or {}).get("attention")
    listed = attention if isinstance(attention, list) else []
    return [str(one["motor"]) for one in listed if one.get("state") in (State.FAULT, State.WATCH)]


def _pictures(
    wanted: dict[str, str], settings: NotificationSettings, repository: Repository
) -> dict[str, bytes]:
    """Return the trends of motors as PNG, by the same keys; a motor without records has none."""
    found = {}
    for key, motor in wanted.items():
        picture = trend_of(repository, motor, settings.time_zone)
        if picture is not None:
            found[key] = picture
    return found
