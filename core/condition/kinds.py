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
    """What is the matter with a motor: what has changed, or stands out from the first record on."""

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
    STARTS = "starts"
    THERMAL = "thermal"
    """Windings that are hotter than their load explains."""
    AIR_GAP = "air-gap"
    ASYMMETRY = "asymmetry"
    """An asymmetry of unknown cause, of the motor or its channels."""
    OTHER_LOAD = "other-load"
    """What hangs behind the relay's transformers beside the motor: a capacitor, a heater, another motor."""
    UNCLEAR = "unclear"


BESIDE_STATOR: Final = frozenset({Kind.STARTS, Kind.THERMAL, Kind.AIR_GAP})
"""What other parts of a motor have; no condition of a stator names it."""
OF_IMPEDANCE: Final = frozenset(
    {
        Kind.SHORTED_TURNS,
        Kind.CONNECTION,
        Kind.VOLTAGE_CHANNEL,
        Kind.CURRENT_CHANNEL,
        Kind.ASYMMETRY,
        Kind.OTHER_LOAD,
        Kind.UNCLEAR,
    }
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
