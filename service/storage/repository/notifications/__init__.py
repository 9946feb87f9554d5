"""Messages about alarms: made from the journal of alarms, worked off, listed, and forgotten at last."""

from service.storage.repository.notifications.figures import AlarmFigureRows
from service.storage.repository.notifications.lists import NotificationLists
from service.storage.repository.notifications.outbox import OutboxRows
from service.storage.repository.notifications.routing import RoutingRows


class NotificationRows(NotificationLists, OutboxRows, RoutingRows, AlarmFigureRows):
    """All there is to ask of and tell the database about messages."""


__all__ = ["NotificationRows"]
