"""The states of a motor and the kinds of change that are told apart."""

from collections.abc import Collection
from enum import StrEnum
from typing import Final


class State(StrEnum):
    """State of a motor."""

    HEALTHY = "healthy"
    WATCH = "watch"
    FAULT = "fault"
    UNKNOWN = "unknown"


class Kind(StrEnum):
    """What has changed, or stands out from the first record on."""

    NONE = "none"
    SHORTED_TURNS = "shorted-turns"
    VOLTAGE_CHANNEL = "voltage-channel"
    CURRENT_CHANNEL = "current-channel"
    CONNECTION = "connection"
    """A joint with more resistance than it had."""
    SUPPLY = "supply"
    PARAMETERS = "parameters"
    """The motor's negative-sequence impedance is another than it was: other parameters, or another motor."""
    ROTOR = "rotor"
    UNCLEAR = "unclear"


OF_IMPEDANCE: Final = frozenset(
    {Kind.SHORTED_TURNS, Kind.CONNECTION, Kind.VOLTAGE_CHANNEL, Kind.CURRENT_CHANNEL, Kind.UNCLEAR}
)
"""What moves the impedance with no parameter of the motor: records that show it do not tell of parameters."""


def moves_impedance(state: State, kind: Kind, candidates: Collection[Kind]) -> bool:
    """Return whether something has changed that moves the impedance with no parameter of the motor.

    Parameters
    ----------
    state : State
        State of the motor.
    kind : Kind
        What has changed.
    candidates : collection of Kind
        What an unclear kind may be.

    Returns
    -------
    bool
        Whether it has.
    """
    return state in (State.WATCH, State.FAULT) and (
        kind in OF_IMPEDANCE or not OF_IMPEDANCE.isdisjoint(candidates)
    )
