"""What happened while nobody could be told: read from the database's own history, in order."""

from collections.abc import Iterator
from dataclasses import dataclass

from service.gateways.mqtt import documents
from service.gateways.mqtt.broker import Message
from service.gateways.mqtt.position import WINDOW, Place, Position
from service.storage.records import ConditionChange, Cursor
from service.storage.repository import Repository

PAGE = 200


@dataclass(frozen=True, slots=True)
class Telling:
    """Messages, and what is told with them: changes of alarms, or of a motor's condition up to a place."""

    messages: tuple[Message, ...]
    sequences: tuple[int, ...] = ()
    motor: str = ""
    place: Place | None = None

    def note(self, position: Position) -> None:
        """Note in the position that the broker has it."""
        position.told(self.sequences)
        if self.place is not None:
            position.conditions[self.motor] = self.place


class History:
    """Reads what has not been told yet. Every method may raise SQLAlchemyError."""

    def __init__(self, repository: Repository, prefix: str) -> None:
        self._repository = repository
        self._alarms = f"{prefix}/changes/alarms"
        self._conditions = f"{prefix}/changes/conditions"

    def begin(self, position: Position) -> None:
        """Let a new position begin now."""
        latest = self._repository.latest_alarm_change()
        earlier = self._repository.alarm_sequences(latest - WINDOW, limit=2 * WINDOW)
        position.begin(earlier, self._latest())

    def alarms(self, position: Position) -> Telling | None:
        """Return the next changes of alarms; None where all have been told."""
        found = self._repository.alarm_sequences(position.alarms_after, limit=WINDOW + PAGE)
        sequences = position.untold(found)[:PAGE]
        if not sequences:
            return None
        messages = [
            Message(self._alarms, documents.alarm_change(change, alarm), retain=False)
            for change, alarm in self._repository.alarm_changes_of(sequences)
        ]
        return Telling(tuple(messages), sequences=tuple(sequences))

    def conditions(self, position: Position) -> Iterator[Telling]:
        """Yield the changes of each motor's condition that have not been told, oldest first."""
        for motor, latest in self._latest().items():
            told = position.conditions.get(motor)
            if told != latest:
                changes = [
                    Message(self._conditions, documents.condition_change(change), retain=False)
                    for change in reversed(self._untold(motor, told, latest))
                ]
                yield Telling(tuple(changes), motor=motor, place=latest)

    def _latest(self) -> dict[str, Place]:
        found = self._repository.latest_condition_changes()
        return {motor: Place(time_ns, tuple(ids)) for motor, (time_ns, ids) in found.items()}

    def _untold(self, motor: str, told: Place | None, latest: Place) -> list[ConditionChange]:
        """Return what has not been told, latest first.

        A record that comes late may take away what was told. Then the latest change that is left is told.
        """
        if told is not None and latest.time_ns < told.time_ns:
            told = Place(latest.time_ns)
        found: list[ConditionChange] = []
        after: Cursor | None = None
        while True:
            page = self._repository.condition_history(motor, limit=PAGE, after=after)
            for change in page.items:
                if told is not None and change.time_ns < told.time_ns:
                    return found
                if told is None or change.time_ns > told.time_ns or change.id not in told.ids:
                    found.append(change)
            after = page.next
            if after is None:
                return found
