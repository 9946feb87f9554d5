"""Tables of a scenario file about what ails a motor and its sensors, and how that develops."""

from math import inf, sqrt
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from core.machines.parameters import Motor
from core.units import SECONDS_PER_DAY
from ied_sim.motor.cage import USUAL_CAGE, Cage
from ied_sim.motor.course import Points
from ied_sim.motor.eccentricity import Eccentricity
from ied_sim.motor.joint import JointCourse
from ied_sim.motor.plant import rated_current
from ied_sim.motor.sensors import CHANNELS, ChannelChange, Sensors
from ied_sim.motor.slip_rings import SlipRings, turns_ratio
from ied_sim.motor.warming import ALUMINIUM_PER_K, COPPER_PER_K, Warming
from ied_sim.scenario.fault_tables import Phase, Resistance
from ied_sim.scenario.moments import MomentTable, require_rising
from ied_sim.toml_tables import Table

CURRENT_HEADROOM = 12
"""Full scale of the current channels over the peak of the rated current; a starting current must fit."""
VOLTAGE_HEADROOM = 2
MOST_BROKEN = 0.3
"""Largest share of a cage's bars that may be broken."""

Share = Annotated[float, Field(ge=-0.5, le=0.5)]
SixShares = tuple[Share, Share, Share, Share, Share, Share]
Delay = Annotated[float, Field(ge=-20_000, le=20_000)]
SixDelays = tuple[Delay, Delay, Delay, Delay, Delay, Delay]
Number = Annotated[float, Field(ge=0)]
Duration = Annotated[float, Field(gt=0)]


class CagePointTable(MomentTable):
    """One point of the development of broken bars."""

    broken: Number


class CageTable(Table):
    """The rotor's cage: its bars, and how many of them are broken, by now or over time."""

    bars: Annotated[int, Field(ge=8, le=200)] | None = None
    ring_share: Annotated[float, Field(gt=0, lt=1)] = USUAL_CAGE.ring_share
    broken: Number | None = None
    timeline: Annotated[tuple[CagePointTable, ...], Field(min_length=1)] | None = None
    places: tuple[Annotated[int, Field(ge=0)], ...] = ()

    @model_validator(mode="after")
    def _is_one_course_in_time(self) -> Self:
        if self.broken is not None and self.timeline is not None:
            raise ValueError("give either broken or timeline")
        require_rising([point.time_s for point in self.timeline or ()], "timeline")
        return self

    @model_validator(mode="after")
    def _names_each_place_once(self) -> Self:
        if len(set(self.places)) < len(self.places):
            raise ValueError("places name a bar twice")
        return self

    def cage(self, rotor_bars: int | None) -> Cage:
        """Return the cage. Raises ValueError where its places or its broken bars are none of its bars."""
        cage = Cage(self.bars or rotor_bars or USUAL_CAGE.bars, self.ring_share, self.places)
        if max(self.places, default=0) >= cage.bars:
            raise ValueError(f"places name a bar above {cage.bars - 1}, the last of {cage.bars}")
        most = max(broken for _, broken in self._points())
        if most > MOST_BROKEN * cage.bars:
            raise ValueError(f"{most:g} broken bars of {cage.bars} are more than {MOST_BROKEN:.0%}")
        return cage

    def course(self, cage: Cage) -> Points:
        """Return the share of broken bars over time."""
        return tuple((time_s, broken / cage.bars) for time_s, broken in self._points())

    def _points(self) -> Points:
        if self.timeline is None:
            return ((0.0, self.broken or 0.0),)
        return tuple((point.time_s, point.broken) for point in self.timeline)


class RotorPointTable(MomentTable):
    """One point of the course of the resistance at the slip rings."""

    external_ohm: Resistance


class StartStepTable(Table):
    """One step of a start's resistance at the slip rings."""

    after_s: Annotated[float, Field(ge=0, le=600)]
    external_ohm: Resistance


class RotorTable(Table):
    """What is connected to the slip rings of a wound rotor, in ohm of the rotor's own phases."""

    external_ohm: Resistance | None = None
    timeline: Annotated[tuple[RotorPointTable, ...], Field(min_length=1)] | None = None
    contacts_ohm: tuple[Resistance, Resistance, Resistance] = (0.0, 0.0, 0.0)
    start: tuple[StartStepTable, ...] = ()
    start_ends_s: Annotated[float, Field(ge=0, le=600)] = 0.0

    @model_validator(mode="after")
    def _is_one_course_in_time(self) -> Self:
        if self.external_ohm is not None and self.timeline is not None:
            raise ValueError("give either external_ohm or timeline")
        require_rising([point.time_s for point in self.timeline or ()], "timeline")
        return self

    @model_validator(mode="after")
    def _start_comes_to_an_end(self) -> Self:
        times = [step.after_s for step in self.start]
        require_rising(times, "start")
        if self.start and (times[0] != 0 or times[-1] >= self.start_ends_s):
            raise ValueError("start begins with after_s = 0, and its last step lies before start_ends_s")
        return self

    def slip_rings(self, motor: Motor) -> SlipRings:
        """Return the slip rings. Raises ValueError where the motor has a cage."""
        if motor.wound_rotor is None:
            raise ValueError('the motor has a cage: give kind = "wound-rotor" under [motor.nameplate]')
        points = tuple((point.time_s, point.external_ohm) for point in self.timeline or ())
        return SlipRings(
            turns_ratio(motor, motor.wound_rotor.open_circuit_voltage_V),
            self.contacts_ohm,
            points or self.external_ohm or 0.0,
            tuple((step.after_s, step.external_ohm) for step in self.start),
            self.start_ends_s,
        )


class EccentricityTable(Table):
    """How far the rotor is out of the middle of its bore, as shares of the air gap."""

    static: Annotated[float, Field(ge=0, le=0.5)] = 0.0
    dynamic: Annotated[float, Field(ge=0, le=0.4)] = 0.0

    def eccentricity(self) -> Eccentricity:
        """Return the eccentricity."""
        return Eccentricity(self.static, self.dynamic)


class JointPointTable(MomentTable):
    """One point of a joint's development."""

    resistance_ohm: Resistance


class JointTable(Table):
    """A bad joint in one line, of a constant resistance or one that develops."""

    phase: Phase
    resistance_ohm: Resistance | None = None
    timeline: Annotated[tuple[JointPointTable, ...], Field(min_length=1)] | None = None

    @model_validator(mode="after")
    def _is_one_course_in_time(self) -> Self:
        if (self.resistance_ohm is None) == (self.timeline is None):
            raise ValueError("give either resistance_ohm or timeline")
        require_rising([point.time_s for point in self.timeline or ()], "timeline")
        return self

    def course(self) -> JointCourse:
        """Return the joint's development."""
        constant = ((0.0, self.resistance_ohm or 0.0),)
        points = tuple((p.time_s, p.resistance_ohm) for p in self.timeline) if self.timeline else constant
        return JointCourse("abc".index(self.phase), points)


class WarmingTable(Table):
    """The warming of the windings."""

    rise_K: Annotated[float, Field(ge=0, le=300)]
    time_constant_s: Duration = 1800.0
    begin_s: float = 0.0
    idle_share: Annotated[float, Field(ge=0, le=1)] = 0.35
    ambient_K: Annotated[float, Field(ge=-100, le=100)] = 0.0
    ambient_swing_K: Annotated[float, Field(ge=0, le=50)] = 0.0
    cage: Literal["aluminium", "copper"] = "aluminium"

    def warming(self) -> Warming:
        """Return the warming."""
        per_K = {"aluminium": ALUMINIUM_PER_K, "copper": COPPER_PER_K}[self.cage]
        return Warming(rotor_per_K=per_K, **self.model_dump(exclude={"cage"}))


class ChannelChangeTable(MomentTable):
    """A channel that jumps or drifts."""

    channel: Literal["IA", "IB", "IC", "VA", "VB", "VC"]
    gain: Share = 0.0
    delay_us: Delay = 0.0
    gain_per_day: Share = 0.0
    delay_us_per_day: Delay = 0.0
    until_days: float | None = None

    @model_validator(mode="after")
    def _changes_something(self) -> Self:
        drifts = bool(self.gain_per_day or self.delay_us_per_day)
        if not (drifts or self.gain or self.delay_us):
            raise ValueError("give gain, delay_us, gain_per_day or delay_us_per_day")
        if self.until_days is not None:
            if not drifts:
                raise ValueError("until_days belongs to gain_per_day or delay_us_per_day")
            if self.until_days * SECONDS_PER_DAY <= self.time_s:
                raise ValueError("until_days must lie after the beginning")
        return self

    def change(self) -> ChannelChange:
        """Return the change."""
        return ChannelChange(
            channel=CHANNELS.index(self.channel),
            at_s=self.time_s,
            gain=self.gain,
            delay_s=self.delay_us * 1e-6,
            gain_per_day=self.gain_per_day,
            delay_per_day_s=self.delay_us_per_day * 1e-6,
            until_s=inf if self.until_days is None else self.until_days * SECONDS_PER_DAY,
        )


class SensorsTable(Table):
    """The sensors; their ranges follow from the motor by default."""

    gain_errors: SixShares = (0.0,) * 6
    delays_us: SixDelays = (0.0,) * 6
    offsets: SixShares = (0.0,) * 6
    current_delay_us: Annotated[float, Field(ge=0, le=20_000)] = 0.0
    noise: Annotated[float, Field(ge=0, le=0.5)] = 0.0
    full_scale_A: Duration | None = None
    full_scale_V: Duration | None = None
    changes: tuple[ChannelChangeTable, ...] = ()

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
            delays_s=tuple(delay_us * 1e-6 for delay_us in self.delays_us),
            changes=tuple(change.change() for change in self.changes),
        )
