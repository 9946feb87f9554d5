"""Documents of the API about messages and channels. None of them shows a secret."""

from typing import Literal

from pydantic import Field

from service.api.document import Document, Listed
from service.api.times import Time
from service.storage.states import AlarmPriority, NotificationKind, NotificationState


class Notification(Document):
    """A message to one receiver, and what became of it.

    recipient: a mail address; null where the channel has one receiver. site, priority: of the alarms in it.
    alarms: how many it tells of, null before it is first tried. attempts: it has reached its receiver at most
    so often. not_before_time: of the next attempt. finished_time: when it was sent, given up (`dead`) or
    withdrawn. error: why the latest attempt failed, or why the message was withdrawn.
    """

    id: str
    kind: NotificationKind
    state: NotificationState
    channel: str
    recipient: str | None
    site: str | None
    priority: AlarmPriority | None
    alarms: int | None
    created_time: Time = Field(validation_alias="created_ns")
    not_before_time: Time = Field(validation_alias="not_before_ns")
    attempts: int
    tried_time: Time | None = Field(validation_alias="tried_ns")
    finished_time: Time | None = Field(validation_alias="finished_ns")
    error: str | None


class ToldAlarm(Document):
    """An alarm as a message told it: what happened to it, and what it was about."""

    id: str
    event: str
    kind: str
    priority: str
    motor: str | None
    ied: str | None
    subject: str


class NotificationDetails(Notification):
    """A message with the first alarms in it, the most urgent first."""

    told: Listed[ToldAlarm]


class NotificationChannel(Document):
    """A channel of the settings.

    receivers: mail addresses; of other kinds, the host, the program or the kind of service. waiting: how many
    messages wait to be sent; given_up: how many were given up and can be tried again.
    """

    name: str
    kind: Literal["mail", "webhook", "syslog", "command", "apprise"]
    receivers: Listed[str]
    waiting: int
    given_up: int
