"""The registers of the Modbus server: a header, and a block for each motor.

Floats are of 32 bits by IEEE 754 and integers of 32 bits unsigned, the high word first. A figure that is not
known is NaN. docs/integration.md has the map; a test compares the two.
"""

import math
import struct
from collections.abc import Mapping, Sequence
from typing import Final

from core.condition.kinds import Kind, State
from core.units import NANOSECONDS_PER_SECOND
from service.gateways.kind_codes import KIND_CODES, ROTOR_CODES
from service.gateways.plant_state.device_health import DeviceHealth
from service.gateways.plant_state.figures import MotorFigures, PlantState, Quality
from service.storage.states import AlarmPriority, LinkState

VERSION: Final = 1
FIRST_BLOCK: Final = 100
BLOCK: Final = 32
MOST_MOTORS: Final = 2000
REGISTERS: Final = FIRST_BLOCK + BLOCK * MOST_MOTORS

STATES: Final = (State.UNKNOWN, State.HEALTHY, State.WATCH, State.FAULT)
PHASES: Final = (None, "a", "b", "c")
HEALTHS: Final = (
    DeviceHealth.NORMAL,
    DeviceHealth.FAILURE,
    DeviceHealth.CHECK_FUNCTION,
    DeviceHealth.OFF_SPEC,
    DeviceHealth.MAINTENANCE_REQUIRED,
)
"""Numbered as OPC UA for Devices does."""

QUALITIES: Final = (Quality.GOOD, Quality.UNCERTAIN, Quality.BAD)
PRIORITIES: Final = (
    None,
    AlarmPriority.LOW,
    AlarmPriority.MEDIUM,
    AlarmPriority.HIGH,
    AlarmPriority.CRITICAL,
)
LINKS: Final = (LinkState.UNKNOWN, LinkState.UP, LinkState.DOWN, LinkState.QUARANTINED)

LARGEST: Final = 0xFFFF

_HEADER = struct.Struct(">HHHHI HH")
_BLOCK = struct.Struct(">10H 6f II 3f")
assert _BLOCK.size <= 2 * BLOCK  # noqa: S101 - the map is wrong otherwise


def header(state: PlantState, *, blocks: int, alive: int) -> list[int]:
    """Return the first registers: version, blocks, counter, whether it is current, when read, alarms."""
    motors = state.motors.values()
    packed = _HEADER.pack(
        VERSION,
        blocks,
        alive & LARGEST,
        int(state.is_current and state.read_ns > 0),
        state.read_ns // NANOSECONDS_PER_SECOND,
        min(sum(motor.alarms for motor in motors), LARGEST),
        max((PRIORITIES.index(motor.priority) for motor in motors), default=0),
    )
    return _registers(packed)


def blocks(state: PlantState, numbers: Mapping[str, int]) -> Mapping[int, Sequence[int]]:
    """Return the registers of each motor in service, by the address of the first one."""
    return {
        FIRST_BLOCK + BLOCK * numbers[motor.name]: _block(motor, state)
        for motor in state.motors.values()
        if numbers[motor.name] < MOST_MOTORS
    }


def _block(motor: MotorFigures, state: PlantState) -> list[int]:
    relay = state.relays.get(motor.relay)
    low, high = motor.mu_f_ci95 or (None, None)
    return _filled(
        STATES.index(motor.state),
        KIND_CODES.index(motor.kind),
        PHASES.index(motor.phase),
        HEALTHS.index(motor.device_health),
        QUALITIES.index(motor.quality),
        ROTOR_CODES.index(motor.rotor) if motor.rotor in ROTOR_CODES else 0,
        int(motor.stale),
        min(motor.alarms, LARGEST),
        PRIORITIES.index(motor.priority),
        0 if relay is None else LINKS.index(relay.link),
        *(
            math.nan if figure is None else figure
            for figure in (motor.mu_f, low, high, motor.change, motor.detection_limit, motor.load_level)
        ),
        (motor.as_of_ns or 0) // NANOSECONDS_PER_SECOND,
        (motor.since_ns or 0) // NANOSECONDS_PER_SECOND,
        *(motor.phase_probabilities or [math.nan] * 3),
    )


def _filled(*values: float) -> list[int]:
    """Return the registers of a block with these values."""
    registers = _registers(_BLOCK.pack(*values))
    return registers + [0] * (BLOCK - len(registers))


def _registers(packed: bytes) -> list[int]:
    return list(struct.unpack(f">{len(packed) // 2}H", packed))


NOTHING_KNOWN: Final = tuple(
    _filled(
        STATES.index(State.UNKNOWN),
        KIND_CODES.index(Kind.NONE),
        PHASES.index(None),
        HEALTHS.index(DeviceHealth.CHECK_FUNCTION),
        QUALITIES.index(Quality.BAD),
        ROTOR_CODES.index(None),
        int(True),
        0,
        PRIORITIES.index(None),
        LINKS.index(LinkState.UNKNOWN),
        *[math.nan] * 6,
        0,
        0,
        *[math.nan] * 3,
    )
)
"""A block before the first reading, and one that no motor in service has."""
