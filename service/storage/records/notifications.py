"""Messages: to whom, about what, and what became of them."""

from collections.abc import Mapping
from dataclasses import dataclass

from service.storage.states import (
    AlarmPriority,
    NotificationKind,
    NotificationState,
    NotifiedEvent,
)


@dataclass(frozen=True, slots=True)
class Notification:
    """A message to one receiver.

    channel: its name in the settings. recipient: a mail address, empty where the channel has one receiver.
    site, priority: of the alarms in it; the priority is that of the most urgent one. document: what it says;
    None until it is first tried. not_before_ns: of the next attempt. finished_ns: when it was sent, given up
    or withdrawn. error: of the latest attempt that failed, or why it was withdrawn.
    """

    id: str
    kind: NotificationKind
    state: NotificationState
    channel: str
    recipient: str
    site: str | None
    priority: AlarmPriority | None
    document: Mapping[str, object] | None
    created_ns: int
    not_before_ns: int
    attempts: int
    tried_ns: int | None
    finished_ns: int | None
    error: str | None


@dataclass(frozen=True, slots=True)
class NotificationTarget:
    """Who is told of an alarm, and when.

    after_ns: so long after the others; what is told later is an escalation. held_until_ns: when the hours of
    the route begin that tells it; None where it is told now.
    """

    channel: str
    recipient: str
    after_ns: int = 0
    held_until_ns: int | None = None


@dataclass(frozen=True, slots=True)
class NewNotification:
    """A message that says the same whenever it is sent. key: of what is made once only."""

    kind: NotificationKind
    channel: str
    recipient: str
    document: Mapping[str, object]
    key: str | None = None


@dataclass(frozen=True, slots=True)
class Gathering:
    """How alarms are gathered into messages.

    gather_ns: so long a message waits for further ones. pause_ns: between two messages of a bundle.
    """

    gather_ns: int
    pause_ns: int


@dataclass(frozen=True, slots=True)
class Occurrence:
    """What happened to an alarm, as far as it is told."""

    event: NotifiedEvent
    site: str | None
    priority: AlarmPriority
    kind: str
