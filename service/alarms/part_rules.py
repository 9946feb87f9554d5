"""Which alarm a part of a motor makes in which state; stator and starts have rules of their own."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from core.condition.kinds import State
from core.motor_condition.parts import Part
from service.alarms.kinds import AlarmKind

PART_ALARMS: Final[Mapping[tuple[Part, State], AlarmKind]] = MappingProxyType(
    {
        (Part.ROTOR, State.WATCH): AlarmKind.ROTOR_WATCH,
        (Part.ROTOR, State.FAULT): AlarmKind.ROTOR_FAULT,
        (Part.SUPPLY, State.WATCH): AlarmKind.SUPPLY_WATCH,
        (Part.SUPPLY, State.FAULT): AlarmKind.SUPPLY_FAULT,
        (Part.AIR_GAP, State.WATCH): AlarmKind.UNEVEN_AIR_GAP,
        (Part.EFFICIENCY, State.WATCH): AlarmKind.INEFFICIENT,
    }
)
PART_OF_ALARM: Final[Mapping[AlarmKind, Part]] = MappingProxyType(
    {kind: part for (part, _), kind in PART_ALARMS.items()}
)
OVER: Final = "the latest records do not show it any more"
