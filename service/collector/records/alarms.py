"""What records need of a relay's alarms."""

from collections.abc import Collection
from typing import Protocol

from service.storage.states import AlarmKind


class RecordAlarms(Protocol):
    """The alarms of one relay, each raised once however often its cause is seen."""

    def standing(self, kind: AlarmKind) -> frozenset[str]:
        """Return the subjects of the alarms of this kind."""

    def raise_alarm(self, kind: AlarmKind, subject: str, reason: str) -> None:
        """Raise an alarm unless it stands already."""

    def keep(self, kind: AlarmKind, subjects: Collection[str]) -> None:
        """Clear the alarms of this kind whose subject is not among these."""
