"""The states of a motor and the kinds of change that are told apart."""

from enum import StrEnum


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
