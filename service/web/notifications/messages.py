"""Messages as the page lists them: to whom, about what, and what became of them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from service.api.pages import decode, encode
from service.storage import Repository
from service.storage.records import Notification
from service.storage.states import NotificationState
from service.web.addresses import address

MOST_SHOWN: Final = 50

LOOKS: Final[Mapping[NotificationState, str]] = {
    NotificationState.QUEUED: "unknown",
    NotificationState.SENDING: "unknown",
    NotificationState.SENT: "healthy",
    NotificationState.DEAD: "fault",
    NotificationState.WITHDRAWN: "unknown",
}
STATE_WORDS: Final[Mapping[NotificationState, str]] = {
    NotificationState.QUEUED: "waits",
    NotificationState.SENDING: "is being sent",
    NotificationState.SENT: "sent",
    NotificationState.DEAD: "given up",
    NotificationState.WITHDRAWN: "withdrawn",
}


@dataclass(frozen=True, slots=True)
class MessageLine:
    """A message in the list. alarms: how many it tells of; None before it is first tried."""

    message: Notification
    alarms: int | None

    @property
    def look(self) -> str:
        """Return the class of its colour and icon."""
        return LOOKS[self.message.state]

    @property
    def words(self) -> str:
        """Return its state in words."""
        return STATE_WORDS[self.message.state]

    @property
    def can_be_tried(self) -> bool:
        """Tell whether somebody may have it tried again."""
        return self.message.state is NotificationState.DEAD


@dataclass(frozen=True, slots=True)
class Messages:
    """The messages that the page shows."""

    state: NotificationState | None
    channel: str | None
    lines: Sequence[MessageLine]
    next_path: str | None
    states: Sequence[tuple[NotificationState, str]]


def messages(
    repository: Repository, *, state: NotificationState | None, channel: str | None, cursor: str | None
) -> Messages:
    """Read the messages of a page. Raises ProblemError for a cursor that is none."""
    found = repository.notifications(
        limit=MOST_SHOWN, after=decode(cursor, int, str), state=state, channel=channel
    )
    next_path = None
    if found.next is not None:
        next_path = address("/notifications", state=state, channel=channel, cursor=encode(found.next))
    return Messages(state, channel, [_line(one) for one in found.items], next_path, list(STATE_WORDS.items()))


def _line(message: Notification) -> MessageLine:
    number = (message.document or {}).get("number")
    return MessageLine(message, number if isinstance(number, int) else None)
