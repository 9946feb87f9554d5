"""What text reports of relays tell of their motors, as the repository takes and hands it out."""

from dataclasses import dataclass

from service.storage.states import RelayEventKind


@dataclass(frozen=True, slots=True)
class RelayEvent:
    """A start, stop or trip of a motor, by its relay's sequence of events."""

    kind: RelayEventKind
    time_ns: int


@dataclass(frozen=True, slots=True)
class MeteredHours:
    """What the service knows of a time by measured values. first_ns: of the first one; None without any."""

    running_hours: float
    known_hours: float
    first_ns: int | None
