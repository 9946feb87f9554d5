"""Which alarm the rotor of a motor makes, and what is to be done.

The condition of the rotor has been confirmed by several records (core.rotor.trend): nothing chatters.
"""

from collections.abc import Mapping
from typing import Final

from core.rotor.finding import RotorState
from service.alarms.catalogue import CATALOGUE
from service.alarms.kinds import AlarmKind

KINDS: Final[Mapping[RotorState, AlarmKind]] = {
    RotorState.WATCH: AlarmKind.ROTOR_WATCH,
    RotorState.FAULT: AlarmKind.ROTOR_FAULT,
}
"""The states that somebody has to look after."""

NOTHING_TO_DO: Final = "Nothing needs to be done."
NOT_TOLD: Final = (
    "Have longer recordings made, of ten seconds if the relay can, at half of the rated load or more: the "
    "reasons of each record say what it lacks."
)


def rotor_advice(state: RotorState) -> str:
    """Return what is to be done about a rotor in this state."""
    kind = KINDS.get(state)
    if kind is not None:
        return CATALOGUE[kind].action
    return NOT_TOLD if state is RotorState.UNSUPPORTED else NOTHING_TO_DO
