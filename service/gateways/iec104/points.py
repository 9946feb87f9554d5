"""The points of each motor: what each is, and its value of the moment.

docs/integration.md has the addresses; a test compares the two.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Final

from core.condition.assessment import PHASES
from core.condition.kinds import State
from service.gateways.iec104.telegrams import Type, Value, scaled, short_float, single_point
from service.gateways.kind_codes import KIND_CODES
from service.gateways.plant_state.figures import MotorFigures, PlantState, Quality
from service.storage.states import LinkState

FIRST: Final = 1000
BLOCK: Final = 16
MOST_MOTORS: Final = 20_000
PERCENT: Final = 100.0

SINGLE, FLOAT, WHOLE = Type.M_SP_TB_1, Type.M_ME_TF_1, Type.M_ME_TE_1

QUALITIES: Final = {Quality.GOOD: 0x00, Quality.UNCERTAIN: 0x40, Quality.BAD: 0x80}
"""Quality descriptor (IEC 60870-5-101, 7.2.6.3): not topical, invalid."""


@dataclass(frozen=True, slots=True)
class Said:
    """What a point tells. number: 0 or 1 of single points.  time_ns: of the record, or of the link.

    read_ns: when it was read, of what has no such time. That it was read again is nothing to tell.
    """

    number: float
    quality: Quality
    time_ns: int | None
    read_ns: int | None = field(default=None, compare=False)

    def value(self, kind: Type) -> Value:
        """Return it as a point of this kind has it."""
        quality = QUALITIES[self.quality]
        time_ns = self.read_ns if self.time_ns is None else self.time_ns
        if kind is SINGLE:
            return single_point(on=bool(self.number), quality=quality, time_ns=time_ns)
        if kind is FLOAT:
            return short_float(self.number, quality=quality, time_ns=time_ns)
        return scaled(int(self.number), quality=quality, time_ns=time_ns)


GONE: Final = Said(0.0, Quality.BAD, None)
"""Of a motor that is no longer in service, or of which nothing is known."""


@dataclass(frozen=True, slots=True)
class MotorPoint:
    """A point of each motor. read: its value; None where it is not known.  of_records: they tell it."""

    kind: Type
    meaning: str
    read: Callable[[MotorFigures], float | bool | None]
    of_records: bool = True


def _percent(value: float | None) -> float | None:
    return None if value is None else PERCENT * value


def _end(interval: tuple[float, float] | None, which: int) -> float | None:
    return None if interval is None else PERCENT * interval[which]


def _of_phase(which: int, motor: MotorFigures) -> float | None:
    return None if motor.phase_probabilities is None else PERCENT * motor.phase_probabilities[which]


WORSE: Final = (State.WATCH, State.FAULT)
POINTS: Final = (
    MotorPoint(SINGLE, "Watch or fault", lambda one: one.state in WORSE),
    MotorPoint(SINGLE, "Fault", lambda one: one.state is State.FAULT),
    MotorPoint(FLOAT, "Level of the fault [%]", lambda one: _percent(one.mu_f)),
    MotorPoint(FLOAT, "Lower end of its 95 % interval [%]", lambda one: _end(one.mu_f_ci95, 0)),
    MotorPoint(FLOAT, "Upper end of its 95 % interval [%]", lambda one: _end(one.mu_f_ci95, 1)),
    MotorPoint(FLOAT, "Change since the reference [%]", lambda one: _percent(one.change)),
    MotorPoint(FLOAT, "Detection limit of the latest record [%]", lambda one: _percent(one.detection_limit)),
    MotorPoint(FLOAT, "Load [% of rated]", lambda one: _percent(one.load_level)),
    MotorPoint(WHOLE, "Kind, numbered as for Modbus", lambda one: KIND_CODES.index(one.kind)),
    MotorPoint(WHOLE, "Phase: 0 none, 1 a, 2 b, 3 c", lambda one: (None, "a", "b", "c").index(one.phase)),
    MotorPoint(SINGLE, "An alarm calls for somebody", lambda one: one.alarms > 0, of_records=False),
)
RELAY_ANSWERS: Final = len(POINTS)
"""Offset of the point that tells whether the motor's relay answers."""
LIKELY_PHASES: Final = tuple(
    MotorPoint(FLOAT, f"Probability of phase {phase}, if shorted turns [%]", partial(_of_phase, which))
    for which, phase in enumerate(PHASES)
)
"""The points after that one."""


def address(number: int, offset: int) -> int:
    """Return the information object address of a motor's point."""
    return FIRST + BLOCK * number + offset


def said_of(point: MotorPoint, motor: MotorFigures, state: PlantState) -> Said:
    """Return the value of a motor's point. One that is not known is invalid."""
    value = point.read(motor)
    if value is None:
        return Said(0.0, Quality.BAD, motor.as_of_ns)
    if not point.of_records:
        quality = Quality.GOOD if state.is_current else Quality.UNCERTAIN
        return Said(float(value), quality, None, read_ns=state.read_ns)
    return Said(float(value), motor.quality, motor.as_of_ns)


def link_of(motor: MotorFigures, state: PlantState) -> Said:
    """Return whether the motor's relay answers."""
    relay = state.relays.get(motor.relay)
    if relay is None or relay.link is LinkState.UNKNOWN:
        return GONE
    return Said(float(relay.link is LinkState.UP), relay.quality, relay.changed_ns)
