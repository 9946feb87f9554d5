"""Tables of a scenario file: what each may contain, and what it means.

docs/reference/scenario.md explains them to users.
"""

from math import inf
from typing import Annotated, Self
from zoneinfo import ZoneInfo

from pydantic import Field, model_validator

from ied_sim.misbehaviour import BUILT_IN, PARAMETERS, Kind, Misbehaviour
from ied_sim.motor.load import Load, LoadCycle, Pulsation
from ied_sim.relay.plant_clock import ClockSettings
from ied_sim.relay.protection import DefiniteTime, ProtectionSettings, ThermalOverload
from ied_sim.scenario.access import AccessTable
from ied_sim.scenario.fault_tables import FaultTable, WindingTable
from ied_sim.scenario.feeder_tables import FeederTable, SaturationTable
from ied_sim.scenario.moments import MomentTable, require_rising
from ied_sim.scenario.motor_tables import (
    CageTable,
    EccentricityTable,
    JointTable,
    RotorTable,
    SensorsTable,
    WarmingTable,
)
from ied_sim.scenario.supply_tables import BusTable, SupplyTable
from ied_sim.toml_tables import Table

Level = Annotated[float, Field(ge=0, le=1.5)]
Duration = Annotated[float, Field(gt=0)]


class ClockTable(Table):
    """The plant's clock."""

    start_days_ago: Annotated[float, Field(gt=0, le=3650)]
    speed_up: Annotated[float, Field(gt=1, le=1e6)]
    leap_every_s: Annotated[float, Field(ge=1)] = 5.0

    def settings(self) -> ClockSettings:
        """Return the settings."""
        return ClockSettings(self.start_days_ago, self.speed_up, self.leap_every_s)


class CyclePointTable(Table):
    """One point of a load cycle."""

    at_s: Annotated[float, Field(ge=0)]
    level: Level


class PulsationTable(Table):
    """A pulsation of the load's torque: of a frequency, tied to the shaft, or at twice the slip frequency."""

    depth: Annotated[float, Field(gt=0, le=1)]
    frequency_Hz: Annotated[float, Field(gt=0, le=200)] | None = None
    per_turn: Annotated[float, Field(gt=0, le=20)] | None = None
    at_twice_slip: bool = False

    @model_validator(mode="after")
    def _is_of_one_kind(self) -> Self:
        if [self.frequency_Hz is not None, self.per_turn is not None, self.at_twice_slip].count(True) != 1:
            raise ValueError("give one of frequency_Hz, per_turn and at_twice_slip")
        return self

    def pulsation(self) -> Pulsation:
        """Return the pulsation."""
        return Pulsation(self.depth, self.frequency_Hz or 0.0, self.per_turn or 0.0, self.at_twice_slip)


class LoadTable(Table):
    """The load."""

    level: Level = 0.5
    swing: Annotated[float, Field(ge=0, le=0.5)] = 0.0
    swing_period_s: Annotated[float, Field(ge=0.1)] = 20.0
    cycle: Annotated[tuple[CyclePointTable, ...], Field(min_length=2)] | None = None
    cycle_period_s: Duration | None = None
    pulsations: tuple[PulsationTable, ...] = ()
    inertia_kgm2: Annotated[float, Field(ge=0)] = 0.0

    @model_validator(mode="after")
    def _is_a_cycle(self) -> Self:
        if (self.cycle is None) != (self.cycle_period_s is None):
            raise ValueError("cycle and cycle_period_s belong together")
        if self.cycle is not None and self.cycle_period_s is not None:
            require_rising([point.at_s for point in self.cycle], "cycle")
            if self.cycle[0].at_s != 0 or self.cycle[-1].at_s >= self.cycle_period_s:
                raise ValueError("cycle begins at 0 and its last point lies before cycle_period_s")
        return self

    def load(self) -> Load:
        """Return the load."""
        cycle = None
        if self.cycle is not None and self.cycle_period_s is not None:
            cycle = LoadCycle(tuple((point.at_s, point.level) for point in self.cycle), self.cycle_period_s)
        pulsations = tuple(each.pulsation() for each in self.pulsations)
        return Load(self.level, self.swing, self.swing_period_s, cycle, pulsations, self.inertia_kgm2)


class RecorderTable(Table):
    """The recorder. A value given here replaces the profile's."""

    formats: Annotated[tuple[str, ...], Field(min_length=1)] | None = None
    sample_rate_Hz: Annotated[float, Field(ge=500, le=100_000)] | None = None
    pre_trigger_s: Annotated[float, Field(ge=0, le=10)] | None = None
    post_trigger_s: Annotated[float, Field(gt=0, le=30)] | None = None
    capacity: Annotated[int, Field(ge=1, le=10_000)] | None = None
    load_profile_s: Annotated[float, Field(ge=1)] = 60.0
    time_zone: ZoneInfo | None = None


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
    switch: Annotated[str, Field(pattern=r"^[\w-]+/[\w-]+\.\w+$")] | None = None
    delay_s: Duration | None = None
    after_bytes: Annotated[int, Field(ge=0)] | None = None
    grow_s: Duration | None = None
    entries: Annotated[int, Field(ge=1)] | None = None
    by_bytes: int | None = None
    times: Annotated[int, Field(ge=1)] | None = None
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
    stop: MomentTable | None = None
    bus: str | None = None
    nameplate: dict[str, object] | None = None
    parameters: dict[str, object] | None = None
    supply: SupplyTable = SupplyTable()
    load: LoadTable = LoadTable()
    winding: WindingTable | None = None
    fault: FaultTable | None = None
    joint: JointTable | None = None
    feeder: FeederTable = FeederTable()
    saturation: SaturationTable | None = None
    cage: CageTable = CageTable()
    rotor: RotorTable | None = None
    eccentricity: EccentricityTable = EccentricityTable()
    warming: WarmingTable | None = None
    sensors: SensorsTable = SensorsTable()
    recorder: RecorderTable = RecorderTable()
    triggers: TriggersTable = TriggersTable()
    protection: ProtectionTable = ProtectionTable()
    misbehaviour: tuple[MisbehaviourTable, ...] = ()
    access: AccessTable = AccessTable()

    @model_validator(mode="after")
    def _has_one_supply(self) -> Self:
        if self.bus is not None and self.supply.model_fields_set - {"sequence"}:
            raise ValueError("a motor on a bus has no supply of its own; supply.sequence alone may be given")
        return self

    @model_validator(mode="after")
    def _can_be_stopped(self) -> Self:
        if self.stopped and self.stop is not None:
            raise ValueError("give either stopped or stop")
        return self


class FileTable(Table):
    """A whole scenario file."""

    motor: tuple[MotorTable, ...]
    bus: tuple[BusTable, ...] = ()
    clock: ClockTable | None = None
