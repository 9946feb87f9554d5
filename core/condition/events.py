"""What people or the plant's files say about a motor, and what of its history it ends."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Final


class EventKind(StrEnum):
    """Kinds of events; each says what it resets (`docs/reference/condition.md`)."""

    RECORDER_CHANGED = "recorder-changed"
    """Relay, transformers or ratios are others: standing errors of the channels are learnt anew."""
    PARAMETERS_EDITED = "parameters-edited"
    """The motor's file has other parameters: the impedance error moves by the difference."""
    REWOUND = "rewound"
    """The motor is another: everything is learnt anew."""
    MAINTENANCE = "maintenance"
    """Somebody worked at the motor: a change that was open is closed, the standing errors are less sure."""
    REFERENCE_RESTARTED = "reference-restarted"
    """A person declares the motor healthy as it is: the standing asymmetry is learnt anew."""
    NOTE = "note"
    """A remark of a person, for people: it resets nothing."""


ENDING: Final = frozenset(
    (
        EventKind.RECORDER_CHANGED,
        EventKind.REWOUND,
        EventKind.MAINTENANCE,
        EventKind.REFERENCE_RESTARTED,
    )
)
"""Events that end the reference. Maintenance does not where shorted turns were named."""


@dataclass(frozen=True, slots=True)
class Event:
    """Something that is known, not guessed from records.

    Parameters
    ----------
    time_ns : int
        When it happened, UTC [ns]. It lies before all records of the same or a later time.
    kind : EventKind
        What happened.
    reason : str
        Why, in a person's words, or what differs.
    """

    time_ns: int
    kind: EventKind
    reason: str = ""
