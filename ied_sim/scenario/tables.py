"""Tables of a scenario file: what each may contain, and what it means.

docs/reference/scenario.md explains them to users.
"""

from math import inf, radians, sqrt
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from core.machines.parameters import Motor, Nameplate
from ied_sim.misbehaviour import BUILT_IN, PARAMETERS, Kind, Misbehaviour
from ied_sim.motor.fault import FaultCourse
from ied_sim.motor.load import Load, LoadCycle
from ied_sim.motor.plant import rated_current
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Harmonic, Supply, SupplyEvent
from ied_sim.motor.warming import Warming
from ied_sim.relay.protection import DefiniteTime, ProtectionSettings, ThermalOverload
from ied_sim.scenario.access import AccessTable
from ied_sim.toml_tables import Table

CURRENT_HEADROOM = 12
"""Full scale of the current channels over the peak of the rated current; a starting current must fit."""
VOLTAGE_HEADROOM = 2

Share = Annotated[float, Field(ge=-0.5, le=0.5)]
SixShares = tuple[Share, Share, Share, Share, Share, Share]
Turns = Annotated[float, Field(ge=0, le=0.5)]
Level = Annotated[float, Field(ge=0, le=1.5)]
Duration = Annotated[float, Field(gt=0)]


class HarmonicTable(Table):
    """A harmonic voltage of the supply."""

    order: Annotated[int, Field(ge=2, le=50)]
    fraction: Annotated[float, Field(ge=0, le=0.5)]
    angle_deg: float = 0.0

    @model_validator(mode="after")
    def _has_a_sequence(self) -> Self:
        if self.order % 3 == 0:
            raise ValueError(f"order {self.order} has no sequence and drives no current into three wires")
        return self


class SupplyEventTable(Table):
    """A dip, swell or interruption of the supply."""

    at_s: float
    duration_s: Duration
    factor: Annotated[float, Field(ge=0, le=1.5)]
    phases: Annotated[str, Field(pattern="^[abc]{1,3}$")] = "abc"
    every_s: Duration | None = None

    @model_validator(mode="after")
    def _ends_before_it_comes_again(self) -> Self:
        if self.every_s is not None and self.duration_s >= self.every_s:
            raise ValueError("duration_s must be less than every_s")
        return self

    def event(self) -> SupplyEvent:
        """Return the event."""
        phases = tuple(sorted({"abc".index(phase) for phase in self.phases}))
        return SupplyEvent(self.at_s, self.duration_s, self.factor, phases, self.every_s)


class SupplyTable(Table):
    """The supply; voltage and frequency are the motor's rated ones by default."""

    line_voltage_V: Duration | None = None
    frequency_Hz: Annotated[float, Field(gt=10, lt=500)] | None = None
    frequency_drift_Hz: Annotated[float, Field(ge=0, le=2)] = 0.0
    drift_period_s: Annotated[float, Field(ge=10)] = 300.0
    unbalance: Annotated[float, Field(ge=0, le=0.3)] = 0.0
    unbalance_angle_deg: float = 0.0
    harmonics: tuple[HarmonicTable, ...] = ()
    sequence: Literal["abc", "acb"] = "abc"
    events: tuple[SupplyEventTable, ...] = ()

    def supply(self, nameplate: Nameplate) -> Supply:
        """Return the supply of a motor."""
        return Supply(
            line_voltage_V=self.line_voltage_V or nameplate.rated_voltage_V,
            frequency_Hz=self.frequency_Hz or nameplate.rated_frequency_Hz,
            frequency_drift_Hz=self.frequency_drift_Hz,
            drift_period_s=self.drift_period_s,
            unbalance=self.unbalance,
            unbalance_angle_rad=radians(self.unbalance_angle_deg),
            harmonics=tuple(Harmonic(h.order, h.fraction, radians(h.angle_deg)) for h in self.harmonics),
            sequence=self.sequence,
            events=tuple(event.event() for event in self.events),
        )


class CyclePointTable(Table):
    """One point of a load cycle."""

    at_s: Annotated[float, Field(ge=0)]
    level: Level


class LoadTable(Table):
    """The load."""

    level: Level = 0.5
    swing: Annotated[float, Field(ge=0, le=0.5)] = 0.0
    swing_period_s: Annotated[float, Field(ge=0.1)] = 20.0
    cycle: Annotated[tuple[CyclePointTable, ...], Field(min_length=2)] | None = None
    cycle_period_s: Duration | None = None

    @model_validator(mode="after")
    def _is_a_cycle(self) -> Self:
        if (self.cycle is None) != (self.cycle_period_s is None):
            raise ValueError("cycle and cycle_period_s belong together")
        if self.cycle is not None and self.cycle_period_s is not None:
            _rising([point.at_s for point in self.cycle], "cycle")
            if self.cycle[0].at_s != 0 or self.cycle[-1].at_s >= self.cycle_period_s:
                raise ValueError("cycle begins at 0 and its last point lies before cycle_period_s")
        return self

    def load(self) -> Load:
        """Return the load."""
        cycle = None
        if self.cycle is not None and self.cycle_period_s is not None:
            cycle = LoadCycle(tuple((point.at_s, point.level) for point in self.cycle), self.cycle_period_s)
        return Load(self.level, self.swing, self.swing_period_s, cycle)


class TimelinePointTable(Table):
    """One point of a fault's development."""

    at_s: float
    level: Turns


class FaultTable(Table):
    """Shorted turns, of a constant level or one that develops."""

    phase: Literal["a", "b", "c"]
    level: Turns | None = None
    timeline: Annotated[tuple[TimelinePointTable, ...], Field(min_length=1)] | None = None
    resistance_ohm: Annotated[float, Field(ge=0)] = 0.0

    @model_validator(mode="after")
    def _is_one_course_in_time(self) -> Self:
        if (self.level is None) == (self.timeline is None):
            raise ValueError("give either level or timeline")
        _rising([point.at_s for point in self.timeline or ()], "timeline")
        return self

    def course(self) -> FaultCourse:
        """Return the fault's development."""
        constant = ((0.0, self.level or 0.0),)
        points = tuple((p.at_s, p.level) for p in self.timeline) if self.timeline else constant
        return FaultCourse("abc".index(self.phase), points, self.resistance_ohm)


class WarmingTable(Table):
    """The warming of the windings."""

    rise_K: Annotated[float, Field(ge=0, le=300)]
    time_constant_s: Duration = 1800.0
    begin_s: float = 0.0

    def warming(self) -> Warming:
        """Return the warming."""
        return Warming(self.rise_K, self.time_constant_s, self.begin_s)


class SensorsTable(Table):
    """The sensors; their ranges follow from the motor by default."""

    gain_errors: SixShares = (0.0,) * 6
    offsets: SixShares = (0.0,) * 6
    current_delay_us: Annotated[float, Field(ge=0, le=20_000)] = 0.0
    noise: Annotated[float, Field(ge=0, le=0.5)] = 0.0
    full_scale_A: Duration | None = None
    full_scale_V: Duration | None = None

    def sensors(self, motor: Motor) -> Sensors:
        """Return the sensors at a motor."""
        phase_peak_V = sqrt(2 / 3) * motor.nameplate.rated_voltage_V
        return Sensors(
            full_scale_A=self.full_scale_A or CURRENT_HEADROOM * sqrt(2) * rated_current(motor),
            full_scale_V=self.full_scale_V or VOLTAGE_HEADROOM * phase_peak_V,
            gain_errors=self.gain_errors,
            offsets=self.offsets,
            current_delay_s=self.current_delay_us * 1e-6,
            noise=self.noise,
        )


class RecorderTable(Table):
    """The recorder. A value given here replaces the profile's."""

    formats: Annotated[tuple[str, ...], Field(min_length=1)] | None = None
    sample_rate_Hz: Annotated[float, Field(ge=500, le=100_000)] | None = None
    pre_trigger_s: Annotated[float, Field(ge=0, le=10)] | None = None
    post_trigger_s: Annotated[float, Field(gt=0, le=30)] | None = None
    capacity: Annotated[int, Field(ge=1, le=10_000)] | None = None
    load_profile_s: Annotated[float, Field(ge=1)] = 60.0


class TriggersTable(Table):
    """The triggers. A value given here replaces the profile's."""

    trip: bool | None = None
    motor_start: bool | None = None
    load_above: Duration | None = None


class DefiniteTimeTable(Table):
    """A definite-time element of the protection."""

    pickup: Duration
    delay_s: Annotated[float, Field(ge=0)] = 0.0

    def element(self) -> DefiniteTime:
        """Return the element."""
        return DefiniteTime(self.pickup, self.delay_s)


class ThermalTable(Table):
    """The thermal overload element of the protection."""

    service_factor: Annotated[float, Field(ge=1, le=2)] = 1.15
    time_constant_s: Duration = 600.0

    def element(self) -> ThermalOverload:
        """Return the element."""
        return ThermalOverload(self.service_factor, self.time_constant_s)


class ProtectionTable(Table):
    """The protection; an element without a table is not in use."""

    overcurrent: DefiniteTimeTable | None = None
    unbalance: DefiniteTimeTable | None = None
    thermal: ThermalTable | None = None

    def settings(self) -> ProtectionSettings:
        """Return the settings."""
        overcurrent, unbalance, thermal = self.overcurrent, self.unbalance, self.thermal
        return ProtectionSettings(
            overcurrent=None if overcurrent is None else overcurrent.element(),
            unbalance=None if unbalance is None else unbalance.element(),
            thermal=None if thermal is None else thermal.element(),
        )


class MisbehaviourTable(Table):
    """One misbehaviour; a kind has at most one of the numbers."""

    kind: Kind
    at_s: Annotated[float, Field(ge=0)] | None = None
    for_s: Duration = inf
    switch: Annotated[str, Field(pattern=r"^\w+/\w+\.\w+$")] | None = None
    delay_s: Duration | None = None
    after_bytes: Annotated[int, Field(ge=0)] | None = None
    grow_s: Duration | None = None
    entries: Annotated[int, Field(ge=1)] | None = None
    by_bytes: int | None = None
    offset_s: float | None = None
    sessions: Annotated[int, Field(ge=0)] | None = None
    error: Annotated[int, Field(ge=0, le=11)] | None = None
    fields: Annotated[int, Field(ge=0, le=255)] | None = None

    @model_validator(mode="after")
    def _comes_and_goes_only_if_it_can(self) -> Self:
        switched = self.at_s is not None or self.switch is not None or self.for_s != inf
        if self.kind in BUILT_IN and switched:
            raise ValueError(f"{self.kind} without at_s, for_s and switch: it is there from the start")
        return self

    @model_validator(mode="after")
    def _has_the_number_of_its_kind(self) -> Self:
        own = PARAMETERS.get(self.kind, ("", 0.0))[0]
        for name in {name for name, _ in PARAMETERS.values()} - {own}:
            if getattr(self, name) is not None:
                raise ValueError(f"{self.kind} has no {name}")
        return self

    def misbehaviour(self) -> Misbehaviour:
        """Return the misbehaviour; it is on from the start where neither at_s nor switch says otherwise."""
        name, default = PARAMETERS.get(self.kind, ("kind", 0.0))
        given = None if self.kind not in PARAMETERS else getattr(self, name)
        at_s = 0.0 if self.at_s is None and self.switch is None else self.at_s
        number = default if given is None else float(given)
        return Misbehaviour(self.kind, number, at_s, self.for_s, self.switch)


class MotorTable(Table):
    """A motor and its relay."""

    ied: Annotated[str, Field(min_length=1)]
    profile: str | None = None
    seed: Annotated[int, Field(ge=0)] = 0
    stopped: bool = False
    broken_bars: Annotated[float, Field(ge=0, le=0.3)] = 0.0
    nameplate: dict[str, object] | None = None
    parameters: dict[str, object] | None = None
    supply: SupplyTable = SupplyTable()
    load: LoadTable = LoadTable()
    fault: FaultTable | None = None
    warming: WarmingTable | None = None
    sensors: SensorsTable = SensorsTable()
    recorder: RecorderTable = RecorderTable()
    triggers: TriggersTable = TriggersTable()
    protection: ProtectionTable = ProtectionTable()
    misbehaviour: tuple[MisbehaviourTable, ...] = ()
    access: AccessTable = AccessTable()


class FileTable(Table):
    """A whole scenario file."""

    motor: tuple[MotorTable, ...]


def _rising(times: list[float], field: str) -> None:
    if times != sorted(set(times)):
        raise ValueError(f"at_s must rise from each point of {field} to the next")
