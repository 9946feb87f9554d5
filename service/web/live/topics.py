"""What pages may want to be told of."""

from dataclasses import dataclass

from service.storage.repository.overviews.change_stamps import Subject

OF_MOTOR = "motor"
LONGEST = 300


@dataclass(frozen=True, slots=True)
class Topic:
    """A subject, or a motor: "fleet", "alarms", "relays", "recordings", "people", "motor:PUMP-A1"."""

    subject: Subject | None
    motor: str | None = None

    @property
    def event(self) -> str:
        """Return the name of the event that tells of it: that of the subject, or "motor"."""
        return OF_MOTOR if self.subject is None else self.subject.value

    def __str__(self) -> str:
        """Return it as addresses have it."""
        return f"{OF_MOTOR}:{self.motor}" if self.subject is None else self.subject.value


def topic_of(text: str) -> Topic:
    """Return the topic that an address names. Raises ValueError."""
    kind, colon, motor = text.partition(":")
    if kind == OF_MOTOR and colon and motor and len(motor) <= LONGEST:
        return Topic(None, motor)
    subjects = [subject.value for subject in Subject]
    if text not in subjects:
        expected = ", ".join([*subjects, f"{OF_MOTOR}:NAME"])
        raise ValueError(f"expected one of {expected}, found {text[:50]!r}")
    return Topic(Subject(text))
