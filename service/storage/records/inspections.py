"""What people found when they inspected motors, as the repository hands it out."""

from dataclasses import dataclass

from core.condition.kinds import Kind
from service.audit.acting import in_words
from service.storage.states import InspectionOutcome


@dataclass(frozen=True, slots=True)
class NewInspection:
    """What somebody tells of an inspection. kind, finding: what the service had said of the motor."""

    time_ns: int
    kind: Kind
    finding: str
    outcome: InspectionOutcome
    text: str
    cause: str | None = None
    alarm_id: str | None = None


@dataclass(frozen=True, slots=True)
class Inspection:
    """An inspection, with how many pictures it has. withdrawn_...: None while it counts."""

    id: str
    motor: str
    time_ns: int
    kind: Kind
    finding: str
    outcome: InspectionOutcome
    cause: str | None
    text: str
    alarm_id: str | None
    account: str
    by: str
    made_ns: int
    withdrawn_ns: int | None
    withdrawn_account: str | None
    withdrawn_reason: str | None
    pictures: int

    @property
    def on_behalf_of(self) -> str | None:
        """Return whom somebody named as who tells it; None for nobody but the account."""
        return None if self.by == self.account else self.by

    @property
    def who(self) -> str:
        """Return who told it, in words."""
        return in_words(self.account, self.on_behalf_of)


@dataclass(frozen=True, slots=True)
class InspectionPicture:
    """A picture of an inspection."""

    media_type: str
    content: bytes


@dataclass(frozen=True, slots=True)
class InspectionCount:
    """Inspections of one kind of finding at a site in a year (UTC). kind: "none" where nothing was said.

    confirmed: hits. other_cause: something else was the matter; misses, where nothing was said.
    nothing_found: false alarms; rightly nothing, where nothing was said.
    """

    kind: Kind
    site: str
    year: int
    confirmed: int
    other_cause: int
    nothing_found: int

    @property
    def missed(self) -> int:
        """Return how many had something of which nothing was said."""
        return self.other_cause if self.kind is Kind.NONE else 0
