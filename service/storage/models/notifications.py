"""Tables of messages: those that wait to be sent, and what became of the others."""

from collections.abc import Mapping

from sqlalchemy import ForeignKey, Index, String
from sqlalchemy.orm import Mapped, mapped_column

from service.storage.models.base import Base
from service.storage.states import AlarmPriority, NotificationKind, NotificationState, NotifiedEvent


class NotificationRow(Base):
    """A message to one receiver.

    channel: its name in the settings. recipient: a mail address, empty where the channel has one receiver.
    key: of what is made once only, such as the digest of a day. bundle: what alarms are gathered by until
    `closes_ns`. is_held: it waits for the hours of its route. document: what it says; null until it is first
    tried, when the alarms in it are looked up. not_before_ns: of the next attempt. claim: who is sending it.
    tried_ns: the latest attempt. finished_ns: when it was sent, given up or withdrawn. error: of the latest
    attempt that failed, or why it was withdrawn.
    """

    __tablename__ = "notifications"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    kind: Mapped[NotificationKind]
    state: Mapped[NotificationState]
    channel: Mapped[str]
    recipient: Mapped[str]
    key: Mapped[str | None] = mapped_column(unique=True)
    bundle: Mapped[str | None]
    site: Mapped[str | None]
    priority: Mapped[AlarmPriority | None]
    is_held: Mapped[bool]
    document: Mapped[Mapping[str, object] | None]
    created_ns: Mapped[int]
    closes_ns: Mapped[int]
    not_before_ns: Mapped[int]
    attempts: Mapped[int]
    claim: Mapped[str | None]
    tried_ns: Mapped[int | None]
    finished_ns: Mapped[int | None]
    error: Mapped[str | None]

    __table_args__ = (
        Index("ix_notifications_state_channel_not_before_ns_id", "state", "channel", "not_before_ns", "id"),
        Index("ix_notifications_bundle_closes_ns", "bundle", "closes_ns"),
        Index("ix_notifications_created_ns_id", "created_ns", "id"),
        Index("ix_notifications_state_created_ns_id", "state", "created_ns", "id"),
        Index("ix_notifications_channel_created_ns_id", "channel", "created_ns", "id"),
        Index("ix_notifications_finished_ns", "finished_ns"),
    )


class NotificationAlarmRow(Base):
    """What happened to an alarm and is told in a message. sequence: of the alarm's change."""

    __tablename__ = "notification_alarms"

    notification: Mapped[str] = mapped_column(
        String(36), ForeignKey("notifications.id", ondelete="CASCADE"), primary_key=True
    )
    sequence: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    alarm: Mapped[str] = mapped_column(String(36))
    event: Mapped[NotifiedEvent]

    __table_args__ = (Index("ix_notification_alarms_alarm_notification", "alarm", "notification"),)
