"""What is to be done about a motor's rotor.

Its condition has been confirmed by several records (`core.rotor.trend`): nothing chatters.
"""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from core.rotor.finding import RotorState

ADVICE: Final[Mapping[RotorState, str]] = MappingProxyType(
    {
        RotorState.HEALTHY: "Nothing needs to be done.",
        RotorState.WATCH: (
            "Have recordings of ten seconds made at half of the rated load or more, and watch the trend of "
            "the rotor on the motor's page."
        ),
        RotorState.FAULT: (
            "Have the cage inspected at the next planned stop (of a wound rotor brushes and rings), start "
            "the motor as seldom as possible until then, and compare its starts with earlier ones."
        ),
        RotorState.UNSUPPORTED: (
            "Have longer recordings made, of ten seconds if the relay can, at half of the rated load or "
            "more: the reasons of each record say what it lacks."
        ),
    }
)


def rotor_advice(state: RotorState) -> str:
    """Return what is to be done about a rotor.

    Parameters
    ----------
    state : RotorState
        Its state.

    Returns
    -------
    str
        A sentence or two.
    """
    return ADVICE[state]
