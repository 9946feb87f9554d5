"""Tables of a scenario file about the supply: of one motor, or of a bus that several motors share."""

import cmath
from math import radians
from typing import Annotated, Literal, Self
from zlib import crc32

from pydantic import Field, model_validator

from core.machines.parameters import Nameplate
from ied_sim.motor.supply import Harmonic, Supply, SupplyEvent, SupplyStep, SupplyWander
from ied_sim.scenario.moments import MomentTable
from ied_sim.toml_tables import Table

Duration = Annotated[float, Field(gt=0)]
Unbalance = Annotated[float, Field(ge=0, le=0.3)]
Frequency = Annotated[float, Field(gt=10, lt=500)]


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


class SupplyStepTable(MomentTable):
    """A lasting change of the supply, added to what it was."""

    voltage: Annotated[float, Field(ge=-0.3, le=0.3)] = 0.0
    unbalance: Unbalance = 0.0
    unbalance_angle_deg: float = 0.0
    zero_sequence: Unbalance = 0.0
    zero_sequence_angle_deg: float = 0.0

    def step(self) -> SupplyStep:
        """Return the step."""
        return SupplyStep(
            self.time_s,
            self.voltage,
            cmath.rect(self.unbalance, radians(self.unbalance_angle_deg)),
            cmath.rect(self.zero_sequence, radians(self.zero_sequence_angle_deg)),
        )


class SupplyWanderTable(Table):
    """The slow random wander of the supply."""

    voltage: Annotated[float, Field(ge=0, le=0.05)] = 0.0
    unbalance: Annotated[float, Field(ge=0, le=0.05)] = 0.0
    zero_sequence: Annotated[float, Field(ge=0, le=0.05)] = 0.0
    time_constant_s: Annotated[float, Field(ge=60)] = 10_800.0


class BusbarTable(Table):
    """What the supply of a motor and that of a bus have in common."""

    line_voltage_V: Duration | None = None
    frequency_Hz: Frequency | None = None
    frequency_drift_Hz: Annotated[float, Field(ge=0, le=2)] = 0.0
    drift_period_s: Annotated[float, Field(ge=10)] = 300.0
    unbalance: Unbalance = 0.0
    unbalance_angle_deg: float = 0.0
    zero_sequence: Unbalance = 0.0
    zero_sequence_angle_deg: float = 0.0
    harmonics: tuple[HarmonicTable, ...] = ()
    events: tuple[SupplyEventTable, ...] = ()
    wander: SupplyWanderTable | None = None
    steps: tuple[SupplyStepTable, ...] = ()

    def busbar(
        self, nameplate: Nameplate, sequence: Literal["abc", "acb"], *, name: str, seed: int
    ) -> Supply:
        """Return the supply of a motor; `name` and `seed` tell its wander from that of others."""
        wander = None
        if self.wander is not None:
            wander = SupplyWander(**self.wander.model_dump(), seed=seed + crc32(name.encode()))
        return Supply(
            line_voltage_V=self.line_voltage_V or nameplate.rated_voltage_V,
            frequency_Hz=self.frequency_Hz or nameplate.rated_frequency_Hz,
            frequency_drift_Hz=self.frequency_drift_Hz,
            drift_period_s=self.drift_period_s,
            unbalance=self.unbalance,
            unbalance_angle_rad=radians(self.unbalance_angle_deg),
            harmonics=tuple(Harmonic(h.order, h.fraction, radians(h.angle_deg)) for h in self.harmonics),
            sequence=sequence,
            events=tuple(event.event() for event in self.events),
            zero_sequence=self.zero_sequence,
            zero_sequence_angle_rad=radians(self.zero_sequence_angle_deg),
            wander=wander,
            steps=tuple(step.step() for step in self.steps),
        )


class SupplyTable(BusbarTable):
    """The supply of one motor; voltage and frequency are its rated ones by default."""

    sequence: Literal["abc", "acb"] = "abc"


class BusTable(BusbarTable):
    """A bus: the supply that all its motors share. Their rated values may differ, so it states its own."""

    name: Annotated[str, Field(min_length=1)]
    seed: Annotated[int, Field(ge=0)] = 0
    line_voltage_V: Duration
    frequency_Hz: Frequency
