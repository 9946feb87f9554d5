"""The plant as gateways tell it: motors, relays and open alarms at one time, each value with its quality."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import TypeVar

from core.condition.assessment import Phase, Phases
from core.condition.kinds import Kind, State
from core.diagnosis.phase_words import phase_in_words
from core.rotor.finding import RotorState
from service.gateways.plant_state.device_health import DeviceHealth
from service.gateways.plant_state.running_state import RunningState
from service.storage.records import Alarm
from service.storage.states import AlarmPriority, LinkState


class Quality(StrEnum):
    """How far a value can be relied on. IEC 61850 calls them good, questionable and invalid."""

    GOOD = "good"
    UNCERTAIN = "uncertain"
    BAD = "bad"


@dataclass(frozen=True, slots=True, kw_only=True)
class MotorFigures:
    """What is told of a motor.

    finding: what is the matter, in words.  phase: of what was found; None where it is not sure.
    phase_probabilities: of a, b and c, where shorted turns were found or may be; None otherwise.
    mu_f: total level of the fault, a fraction of the phase's turns.  change: level since the reference; each
    with its 95 % interval.  detection_limit, load_level: of the latest record that has them.
    rotor: watch or fault, else None.  device_health: by the state.
    since_ns: when the state began.  as_of_ns: time of the latest record in it, and of all values.
    voltage_unbalance, current_unbalance: negative over positive sequence, of the latest record that has them,
    at unbalance_ns.  running_ns: when it was seen to run or stand, or its link ended;
    running_quality: uncertain where that is too long ago.
    alarms: how many call for somebody; priority: of the most urgent one.
    quality, quality_reason: of all figures; the reason is None where it is good.
    """

    name: str
    description: str
    site: str
    relay: str
    state: State
    kind: Kind
    finding: str
    phase: Phase | None
    phase_probabilities: Phases | None
    mu_f: float | None
    mu_f_ci95: tuple[float, float] | None
    change: float | None
    change_ci95: tuple[float, float] | None
    detection_limit: float | None
    load_level: float | None
    rotor: RotorState | None
    device_health: DeviceHealth
    since_ns: int | None
    as_of_ns: int | None
    stale: bool
    advice: str
    reasons: tuple[str, ...]
    alarms: int
    priority: AlarmPriority | None
    quality: Quality
    quality_reason: str | None
    voltage_unbalance: float | None
    current_unbalance: float | None
    unbalance_ns: int | None
    running: RunningState
    running_ns: int | None
    running_quality: Quality

    @property
    def likely_phases(self) -> str:
        """Return the phase that was found or the likely ones, in words; empty where nothing is known."""
        return self.phase or phase_in_words(self.phase_probabilities)


@dataclass(frozen=True, slots=True, kw_only=True)
class RelayFigures:
    """What is told of a relay. link_reason: why it does not answer.  changed_ns: when its link changed."""

    name: str
    site: str
    manufacturer: str
    type: str
    link: LinkState
    link_reason: str | None
    changed_ns: int | None
    device_health: DeviceHealth
    quality: Quality
    quality_reason: str | None


Figures = TypeVar("Figures", MotorFigures, RelayFigures)


@dataclass(frozen=True, slots=True)
class PlantState:
    """All that gateways tell. motors, relays: by name.  alarms: those that are open, by id.

    is_current: False where the database has not answered for long.  read_ns: when it was read.
    """

    motors: Mapping[str, MotorFigures] = field(default_factory=dict)
    relays: Mapping[str, RelayFigures] = field(default_factory=dict)
    alarms: Mapping[str, Alarm] = field(default_factory=dict)
    is_current: bool = True
    read_ns: int = field(default=0, compare=False)

    def as_uncertain(self, reason: str) -> "PlantState":
        """Return it with no value that counts as good any more."""
        motors = {
            name: replace(motor, running_quality=Quality.UNCERTAIN) for name, motor in self.motors.items()
        }
        return replace(
            self,
            motors=_each_uncertain(motors, reason),
            relays=_each_uncertain(self.relays, reason),
            is_current=False,
        )


def _each_uncertain(items: Mapping[str, Figures], reason: str) -> Mapping[str, Figures]:
    return {name: _uncertain(one, reason) for name, one in items.items()}


def _uncertain(one: Figures, reason: str) -> Figures:
    if one.quality is not Quality.GOOD:
        return one
    return replace(one, quality=Quality.UNCERTAIN, quality_reason=reason)


@dataclass(frozen=True, slots=True)
class PlantChange:
    """What was told before, and what is to be told now."""

    before: PlantState
    now: PlantState

    @property
    def motors(self) -> tuple[MotorFigures, ...]:
        """Return the motors of which something else is told, or that are new."""
        return _changed(self.before.motors, self.now.motors)

    @property
    def relays(self) -> tuple[RelayFigures, ...]:
        """Return the relays of which something else is told, or that are new."""
        return _changed(self.before.relays, self.now.relays)

    @property
    def alarms(self) -> tuple[Alarm, ...]:
        """Return the open alarms that changed, or are new."""
        return _changed(self.before.alarms, self.now.alarms)

    @property
    def motors_gone(self) -> tuple[str, ...]:
        """Return the motors that are no longer in service."""
        return _gone(self.before.motors, self.now.motors)

    @property
    def relays_gone(self) -> tuple[str, ...]:
        """Return the relays that are no longer in service."""
        return _gone(self.before.relays, self.now.relays)

    @property
    def alarms_gone(self) -> tuple[str, ...]:
        """Return the ids of the alarms that are over."""
        return _gone(self.before.alarms, self.now.alarms)


Item = TypeVar("Item")


def _changed(before: Mapping[str, Item], now: Mapping[str, Item]) -> tuple[Item, ...]:
    return tuple(item for name, item in now.items() if before.get(name) != item)


def _gone(before: Mapping[str, Item], now: Mapping[str, Item]) -> tuple[str, ...]:
    return tuple(name for name in before if name not in now)
