"""Messages listed: what was sent to whom, and what was not."""

from sqlalchemy import func, select

from service.storage.models import NotificationAlarmRow, NotificationRow
from service.storage.records import Cursor, Notification, Page
from service.storage.repository.sessions import Order, Sessions, columns_of, found, page_of, record_of
from service.storage.states import NotificationState


class NotificationLists(Sessions):
    def notifications(
        self,
        *,
        limit: int,
        after: Cursor | None = None,
        state: NotificationState | None = None,
        channel: str | None = None,
        alarm: str | None = None,
    ) -> Page[Notification]:
        """Return a page of messages, latest first. alarm: only those that told of it; None for all."""
        query = select(*columns_of(Notification, NotificationRow))
        if state is not None:
            query = query.where(NotificationRow.state == state)
        if channel is not None:
            query = query.where(NotificationRow.channel == channel)
        if alarm is not None:
            told = select(NotificationAlarmRow.notification).where(NotificationAlarmRow.alarm == alarm)
            query = query.where(NotificationRow.id.in_(told))
        order: Order = [NotificationRow.created_ns, NotificationRow.id]
        with self._read() as session:
            return page_of(session, query, order, Notification, limit=limit, after=after, descending=True)

    def notification(self, notification_id: str) -> Notification:
        """Return a message. Raises NotFoundError."""
        with self._read() as session:
            return record_of(Notification, found(session, NotificationRow, notification_id, "notification"))

    def waiting_notifications(self) -> dict[tuple[str, NotificationState], int]:
        """Return how many messages of each channel wait, and how many were given up."""
        counted = (
            select(NotificationRow.channel, NotificationRow.state, func.count())
            .where(
                NotificationRow.state.in_(
                    (NotificationState.QUEUED, NotificationState.SENDING, NotificationState.DEAD)
                )
            )
            .group_by(NotificationRow.channel, NotificationRow.state)
        )
        with self._read() as session:
            return {(channel, state): number for channel, state, number in session.execute(counted)}
