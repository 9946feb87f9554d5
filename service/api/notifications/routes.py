"""Messages listed, tried again, and tests of channels."""

import time
from collections.abc import Mapping
from http import HTTPStatus
from typing import Annotated
from urllib.parse import urlsplit
from uuid import UUID

from fastapi import APIRouter, Query

from core.error_words import nearest
from service.access.permissions import Permission
from service.api.access.callers import By
from service.api.access.requirements import require
from service.api.context import Context
from service.api.document import Name
from service.api.notifications.schemas import (
    Notification,
    NotificationChannel,
    NotificationDetails,
    ToldAlarm,
)
from service.api.pages import DEFAULT_LIMIT, CursorText, Limit, Page, decode, page
from service.api.problems import problems
from service.configuration.channels import (
    AppriseChannel,
    Channel,
    CommandChannel,
    MailChannel,
    SyslogChannel,
    WebhookChannel,
)
from service.senders.sending import recipients
from service.storage.errors import NotFoundError
from service.storage.records import Notification as StoredNotification
from service.storage.states import NotificationState

router = APIRouter(tags=["notifications"])

NEEDED = [require(Permission.NOTIFY)]


@router.get("/notifications", responses=problems(404), dependencies=NEEDED)
def list_notifications(
    context: Context,
    state: Annotated[NotificationState | None, Query(description="Only those in this state.")] = None,
    channel: Annotated[
        str | None, Query(max_length=50, description="Only those of this channel of the settings.")
    ] = None,
    alarm: Annotated[UUID | None, Query(description="Only those that told of this alarm.")] = None,
    limit: Limit = DEFAULT_LIMIT,
    cursor: CursorText = None,
) -> Page[Notification]:
    """Return the messages, latest first: what was sent to whom, what waits, and what was given up."""
    if channel is not None:
        _channel(context, channel)
    if alarm is not None:
        context.repository.alarm(str(alarm))
    found = context.repository.notifications(
        state=state,
        channel=channel,
        alarm=None if alarm is None else str(alarm),
        limit=limit,
        after=decode(cursor, int, str),
    )
    return page(found, _document)


@router.get("/notifications/{notification_id}", responses=problems(404), dependencies=NEEDED)
def get_notification(context: Context, notification_id: UUID) -> NotificationDetails:
    """Return one message, with the alarms that it tells of."""
    found = context.repository.notification(str(notification_id))
    listed = (found.document or {}).get("alarms")
    alarms = listed if isinstance(listed, list) else []
    return NotificationDetails(
        **dict(_document(found)), told=[ToldAlarm.model_validate(alarm) for alarm in alarms]
    )


@router.post(
    "/notifications/{notification_id}/attempts",
    status_code=HTTPStatus.ACCEPTED,
    responses=problems(404, 409),
    dependencies=NEEDED,
)
def retry_notification(context: Context, by: By, notification_id: UUID) -> Notification:
    """Try a message again that was given up; 409 where it was not."""
    retried = context.repository.retry_notification(str(notification_id), by=by, now_ns=time.time_ns())
    return _document(retried)


@router.get("/notification-channels", responses=problems(), dependencies=NEEDED)
def list_channels(context: Context) -> Page[NotificationChannel]:
    """Return the channels of the settings; always one page."""
    counts = context.repository.waiting_notifications()
    channels = context.settings.notifications.channels
    return Page(
        items=[_channel_document(name, channel, counts) for name, channel in channels.items()],
        next_cursor=None,
    )


@router.post(
    "/notification-channels/{name}/tests",
    status_code=HTTPStatus.ACCEPTED,
    responses=problems(404, 429),
    dependencies=NEEDED,
)
def send_test(context: Context, by: By, name: Name) -> Page[Notification]:
    """Have a test message sent to each receiver of a channel; it is tried once.

    What becomes of it is seen in `notifications/{notification_id}`.
    """
    channel = _channel(context, name)
    queued = context.repository.request_test_notifications(
        name, recipients(channel), by=by, now_ns=time.time_ns()
    )
    return Page(items=[_document(one) for one in queued], next_cursor=None)


def _channel(context: Context, name: str) -> Channel:
    """Return a channel of the settings. Raises NotFoundError."""
    channels = context.settings.notifications.channels
    if name not in channels:
        raise NotFoundError("channel", name, nearest=nearest(name, channels))
    return channels[name]


def _document(stored: StoredNotification) -> Notification:
    number = (stored.document or {}).get("number")
    return Notification.model_validate(
        {
            "id": stored.id,
            "kind": stored.kind,
            "state": stored.state,
            "channel": stored.channel,
            "recipient": stored.recipient or None,
            "site": stored.site,
            "priority": stored.priority,
            "alarms": number if isinstance(number, int) else None,
            "created_ns": stored.created_ns,
            "not_before_ns": stored.not_before_ns,
            "attempts": stored.attempts,
            "tried_ns": stored.tried_ns,
            "finished_ns": stored.finished_ns,
            "error": stored.error,
        }
    )


def _channel_document(
    name: str, channel: Channel, counts: Mapping[tuple[str, NotificationState], int]
) -> NotificationChannel:
    waiting = (NotificationState.QUEUED, NotificationState.SENDING)
    return NotificationChannel(
        name=name,
        kind=channel.kind,
        receivers=list(_receivers(channel)),
        waiting=sum(counts.get((name, state), 0) for state in waiting),
        given_up=counts.get((name, NotificationState.DEAD), 0),
    )


def _receivers(channel: Channel) -> tuple[str, ...]:
    """Return to whom a channel sends. The path of an address may be a secret, and arguments of a program."""
    match channel:
        case MailChannel():
            return channel.to
        case WebhookChannel():
            if channel.url is None:
                return (channel.format,)
            parsed = urlsplit(channel.url)
            return (f"{parsed.scheme}://{parsed.netloc}",)
        case SyslogChannel():
            return (f"{channel.host}:{channel.server_port} ({channel.transport})",)
        case CommandChannel():
            return (channel.command[0],)
        case AppriseChannel():
            return ("addresses of Apprise",)
