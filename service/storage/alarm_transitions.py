"""The life of an alarm after ISA-18.2 and IEC 62682: what follows from which event in which state.

This is the only table of it. docs/reference/alarms.md shows it, and a test compares the two.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from service.storage.states import AlarmEvent, AlarmState

NORMAL = AlarmState.NORMAL
UNACKNOWLEDGED = AlarmState.UNACKNOWLEDGED
ACKNOWLEDGED = AlarmState.ACKNOWLEDGED
RETURNED = AlarmState.RETURNED_UNACKNOWLEDGED
SHELVED = AlarmState.SHELVED
SUPPRESSED = AlarmState.SUPPRESSED
OUT_OF_SERVICE = AlarmState.OUT_OF_SERVICE


@dataclass(frozen=True, slots=True)
class ByCause:
    """The state that follows depends on whether the cause stands."""

    standing: AlarmState
    gone: AlarmState


Following = AlarmState | ByCause

_ANEW = ByCause(standing=UNACKNOWLEDGED, gone=NORMAL)
"""An alarm that was set aside calls again if its cause stands, and is over if not."""

TRANSITIONS: Mapping[AlarmEvent, Mapping[AlarmState, Following]] = {
    # Of the cause. An alarm that is normal is over: raised again, it is a new one.
    AlarmEvent.RAISED: {
        NORMAL: UNACKNOWLEDGED,
        RETURNED: UNACKNOWLEDGED,
        SHELVED: SHELVED,
        SUPPRESSED: SUPPRESSED,
        OUT_OF_SERVICE: OUT_OF_SERVICE,
    },
    AlarmEvent.CLEARED: {
        UNACKNOWLEDGED: RETURNED,
        ACKNOWLEDGED: NORMAL,
        SHELVED: SHELVED,
        SUPPRESSED: SUPPRESSED,
        OUT_OF_SERVICE: OUT_OF_SERVICE,
    },
    # Another alarm tells the same cause from now on. Nobody has to look after both.
    AlarmEvent.SUPERSEDED: {
        UNACKNOWLEDGED: NORMAL,
        ACKNOWLEDGED: NORMAL,
        RETURNED: NORMAL,
        SHELVED: NORMAL,
        SUPPRESSED: NORMAL,
        OUT_OF_SERVICE: OUT_OF_SERVICE,
    },
    # It has become worse than what people knew when they acknowledged or shelved it.
    AlarmEvent.REOPENED: {ACKNOWLEDGED: UNACKNOWLEDGED, SHELVED: UNACKNOWLEDGED},
    # Of people.
    AlarmEvent.ACKNOWLEDGED: {UNACKNOWLEDGED: ACKNOWLEDGED, RETURNED: NORMAL},
    # By who acknowledged it, within minutes: afterwards others count on it.
    AlarmEvent.ACKNOWLEDGEMENT_UNDONE: {ACKNOWLEDGED: UNACKNOWLEDGED},
    AlarmEvent.SHELVED: {
        UNACKNOWLEDGED: SHELVED,
        ACKNOWLEDGED: SHELVED,
        RETURNED: SHELVED,
        SHELVED: SHELVED,
    },
    AlarmEvent.UNSHELVED: {SHELVED: _ANEW},
    AlarmEvent.TAKEN_OUT_OF_SERVICE: {
        UNACKNOWLEDGED: OUT_OF_SERVICE,
        ACKNOWLEDGED: OUT_OF_SERVICE,
        RETURNED: OUT_OF_SERVICE,
        SHELVED: OUT_OF_SERVICE,
        SUPPRESSED: OUT_OF_SERVICE,
    },
    AlarmEvent.PUT_BACK_IN_SERVICE: {OUT_OF_SERVICE: _ANEW},
    # Of time and of the plant's design. What is quiet already stays as people made it.
    AlarmEvent.SHELVING_ENDED: {SHELVED: _ANEW},
    AlarmEvent.SUPPRESSED: {NORMAL: SUPPRESSED, UNACKNOWLEDGED: SUPPRESSED, RETURNED: SUPPRESSED},
    AlarmEvent.UNSUPPRESSED: {SUPPRESSED: _ANEW},
}

OF_PEOPLE = (
    AlarmEvent.ACKNOWLEDGED,
    AlarmEvent.SHELVED,
    AlarmEvent.UNSHELVED,
    AlarmEvent.TAKEN_OUT_OF_SERVICE,
    AlarmEvent.PUT_BACK_IN_SERVICE,
)
"""These events are what people do; all others come by themselves, but for an undone acknowledgement."""


def following(state: AlarmState, event: AlarmEvent, *, standing: bool) -> AlarmState | None:
    """Return the state that follows; None where the event is not possible.

    standing: whether the cause stands once the event has happened.
    """
    found = TRANSITIONS[event].get(state)
    if isinstance(found, ByCause):
        return found.standing if standing else found.gone
    return found


def possible_for_people(state: AlarmState) -> tuple[AlarmEvent, ...]:
    """Return what people can do about an alarm in this state."""
    return tuple(event for event in OF_PEOPLE if state in TRANSITIONS[event])
