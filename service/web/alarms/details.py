"""One alarm with all that happened to it, and what can be done about it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from service.storage import Repository
from service.storage.alarm_transitions import possible_for_people
from service.storage.records import Alarm, AlarmChange, Notification
from service.storage.states import AlarmEvent

MOST_CHANGES: Final = 100
MOST_MESSAGES: Final = 50
MOST_MEMBERS: Final = 100

SHELVING_HOURS: Final[Sequence[tuple[int, str]]] = (
    (1, "1 hour"),
    (8, "8 hours"),
    (24, "1 day"),
    (72, "3 days"),
    (7 * 24, "1 week"),
    (30 * 24, "30 days"),
    (90 * 24, "90 days"),
)


@dataclass(frozen=True, slots=True)
class AlarmDetails:
    """An alarm as its page shows it.

    possible: what people can do about it in its state.  changes: what happened to it, latest first; more says
    whether there is more than is shown.  messages: what was sent of it; None for those who may not see that.
    members: alarms that it tells in one line.
    """

    alarm: Alarm
    possible: frozenset[AlarmEvent]
    changes: Sequence[AlarmChange]
    more_changes: bool
    messages: Sequence[Notification] | None
    members: Sequence[Alarm]
    more_members: bool

    @property
    def grew(self) -> float | None:
        """Return by how much its value has grown since somebody last took notice of it; None if unknown."""
        if self.alarm.value is None or self.alarm.seen_value is None:
            return None
        return self.alarm.value - self.alarm.seen_value


def alarm_details(repository: Repository, alarm_id: str, *, with_messages: bool) -> AlarmDetails:
    """Read what the page shows. Raises NotFoundError."""
    alarm = repository.alarm(alarm_id)
    changes = repository.alarm_changes(alarm_id, limit=MOST_CHANGES)
    members = repository.alarms(part_of=alarm_id, limit=MOST_MEMBERS)
    messages = None
    if with_messages:
        messages = repository.notifications(alarm=alarm_id, limit=MOST_MESSAGES).items
    return AlarmDetails(
        alarm=alarm,
        possible=frozenset(possible_for_people(alarm.state)),
        changes=changes.items,
        more_changes=changes.next is not None,
        messages=messages,
        members=members.items,
        more_members=members.next is not None,
    )
