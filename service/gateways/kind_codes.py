"""Numbers of kinds, for protocols without words. They are a contract: new ones are added at the end."""

from typing import Final

from core.condition.kinds import Kind
from core.rotor.finding import RotorState

KIND_CODES: Final = (
    Kind.NONE,
    Kind.SHORTED_TURNS,
    Kind.VOLTAGE_CHANNEL,
    Kind.CURRENT_CHANNEL,
    Kind.CONNECTION,
    Kind.SUPPLY,
    Kind.PARAMETERS,
    Kind.ROTOR,
    Kind.UNCLEAR,
    Kind.ASYMMETRY,
    Kind.STARTS,
    Kind.THERMAL,
    Kind.AIR_GAP,
    Kind.OTHER_LOAD,
)
ROTOR_CODES: Final = (None, RotorState.WATCH, RotorState.FAULT)
