"""The points of each motor: what each is, and its value of the moment.

docs/integration.md has the addresses; a test compares the two.
"""

from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Final

import c104

from core.condition.kinds import State
from service.gateways.kind_codes import KIND_CODES
from service.gateways.plant_state.figures import MotorFigures, PlantState, Quality
from service.storage.states import LinkState

FIRST: Final = 1000
BLOCK: Final = 16
MOST_MOTORS: Final = 20_000
PERCENT: Final = 100.0
EPOCH: Final = datetime(1970, 1, 1, tzinfo=UTC)

SINGLE, FLOAT, WHOLE = c104.Type.M_SP_TB_1, c104.Type.M_ME_TF_1, c104.Type.M_ME_TE_1

QUALITIES: Final = {
    Quality.GOOD: c104.Quality(),
    Quality.UNCERTAIN: c104.Quality.NonTopical,
    Quality.BAD: c104.Quality.Invalid,
}


@dataclass(frozen=True, slots=True)
class Said:
    """What a point tells. value: 0 or 1 of single points.  time_ns: of the record, or of the link."""

    value: float
    quality: Quality
    time_ns: int | None

    def information(self, kind: c104.Type) -> c104.Information:
        """Return it as a point of this kind has it."""
        quality = QUALITIES[self.quality]
        recorded_at = EPOCH + timedelta(milliseconds=(self.time_ns or 0) // 1_000_000)
        if kind == SINGLE:
            return c104.SingleInfo(on=bool(self.value), quality=quality, recorded_at=recorded_at)
        if kind == FLOAT:
            return c104.ShortInfo(actual=self.value, quality=quality, recorded_at=recorded_at)
        return c104.ScaledInfo(actual=c104.Int16(int(self.value)), quality=quality, recorded_at=recorded_at)


GONE: Final = Said(0.0, Quality.BAD, None)
"""Of a motor that is no longer in service, or of which nothing is known."""


@dataclass(frozen=True, slots=True)
class MotorPoint:
    """A point of each motor. read: its value; None where it is not known."""

    kind: c104.Type
    meaning: str
    read: Callable[[MotorFigures], float | bool | None]


def _percent(value: float | None) -> float | None:
    return None if value is None else PERCENT * value


def _end(interval: tuple[float, float] | None, which: int) -> float | None:
    return None if interval is None else PERCENT * interval[which]


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
    MotorPoint(SINGLE, "An alarm calls for somebody", lambda one: one.alarms > 0),
)
RELAY_ANSWERS: Final = len(POINTS)
"""Offset of the point that tells whether the motor's relay answers."""


def address(number: int, offset: int) -> int:
    """Return the information object address of a motor's point."""
    return FIRST + BLOCK * number + offset


def said_of(point: MotorPoint, motor: MotorFigures) -> Said:
    """Return the value of a motor's point. One that is not known is invalid."""
    value = point.read(motor)
    if value is None:
        return Said(0.0, Quality.BAD, motor.as_of_ns)
    return Said(float(value), motor.quality, motor.as_of_ns)


def link_of(motor: MotorFigures, state: PlantState) -> Said:
    """Return whether the motor's relay answers."""
    relay = state.relays.get(motor.relay)
    if relay is None or relay.link is LinkState.UNKNOWN:
        return GONE
    return Said(float(relay.link is LinkState.UP), relay.quality, relay.changed_ns)
