"""The page of notifications, and its forms: send a test, try again."""

from typing import Annotated, Final, Literal
from uuid import UUID

from fastapi import APIRouter, Query
from starlette.responses import Response

from service.access.permissions import Permission
from service.api.access.requirements import require
from service.api.document import Name
from service.api.notifications import routes as notifications
from service.storage.states import NotificationState
from service.web.notifications.messages import messages
from service.web.notifications.settings_words import digest_words, route_words
from service.web.view import Looking

router = APIRouter()

NOTIFY: Final = [require(Permission.NOTIFY)]


@router.get("/notifications", dependencies=NOTIFY)
def show_notifications(
    view: Looking,
    state: NotificationState | Literal[""] | None = None,
    channel: Annotated[str | None, Query(max_length=50)] = None,
    cursor: Annotated[str | None, Query(max_length=1000)] = None,
) -> Response:
    """Show who is told of what, and what was sent to whom."""
    settings = view.context.settings.notifications
    return view.page(
        "notifications/page.html",
        title="Notifications",
        channels=notifications.list_channels(view.context).items,
        routes=route_words(settings),
        digests=digest_words(settings),
        found=messages(
            view.context.repository,
            state=NotificationState(state) if state else None,
            channel=channel or None,
            cursor=cursor or None,
        ),
    )


@router.post("/notifications/channels/{name}/test", dependencies=NOTIFY)
def send_test(view: Looking, name: Name) -> Response:
    """Have a test message sent to each receiver of a channel."""
    notifications.send_test(view.context, view.asking.actor, name)
    return view.done("/notifications", "test-queued")


@router.post("/notifications/{notification_id}/attempt", dependencies=NOTIFY)
def try_again(view: Looking, notification_id: UUID) -> Response:
    """Try a message again that was given up."""
    notifications.retry_notification(view.context, view.asking.actor, notification_id)
    return view.done("/notifications", "tried-again")
