"""Tables of a scenario file about the motor's feeder: what lies behind the relay's transformers beside it."""

from math import inf
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from core.machines.parameters import Connection, Motor
from core.units import SECONDS_PER_DAY
from ied_sim.motor.course import Points
from ied_sim.motor.feeder import Cable, Capacitors, Feeder, Heater, OtherMotor
from ied_sim.motor.load import Load
from ied_sim.motor.saturation import EXPONENT, MainSaturation
from ied_sim.scenario.fault_tables import Phase, Resistance
from ied_sim.scenario.moments import MomentTable, require_rising
from ied_sim.toml_tables import Table

Positive = Annotated[float, Field(gt=0)]
Share = Annotated[float, Field(ge=0, le=1)]


class LostPointTable(MomentTable):
    """One point of a capacitor's loss of elements."""

    share: Share


class LostTable(Table):
    """A branch of the bank that has lost elements, by now or over time."""

    branch: Phase
    share: Share | None = None
    timeline: Annotated[tuple[LostPointTable, ...], Field(min_length=1)] | None = None

    @model_validator(mode="after")
    def _is_one_course_in_time(self) -> Self:
        if (self.share is None) == (self.timeline is None):
            raise ValueError("give either share or timeline")
        require_rising([point.time_s for point in self.timeline or ()], "timeline")
        return self


class CapacitorsTable(Table):
    """A bank of capacitors."""

    kvar: Positive
    connection: Connection = Connection.DELTA
    lost: LostTable | None = None

    def capacitors(self) -> Capacitors:
        """Return the bank."""
        lost = self.lost
        if lost is None:
            return Capacitors(self.kvar, self.connection)
        course: Points = ((0.0, lost.share or 0.0),)
        if lost.timeline is not None:
            course = tuple((point.time_s, point.share) for point in lost.timeline)
        return Capacitors(self.kvar, self.connection, "abc".index(lost.branch), course)


class HeaterTable(Table):
    """A resistance between two lines, or from one to the neutral."""

    between: Literal["ab", "bc", "ca", "an", "bn", "cn"]
    power_W: Positive
    since_days: float | None = None

    def heater(self) -> Heater:
        """Return the heater."""
        line, other = self.between
        since_s = -inf if self.since_days is None else SECONDS_PER_DAY * self.since_days
        return Heater(self.power_W, "abc".index(line), None if other == "n" else "abc".index(other), since_s)


class CableTable(Table):
    """A cable between the voltage transformers and the motor."""

    resistance_ohm: Resistance = 0.0
    reactance_ohm: Resistance = 0.0


class OtherMotorTable(Table):
    """A second motor of the same kind behind the same transformers."""

    load_level: Annotated[float, Field(ge=0, le=1.5)] = 0.5
    since_days: float | None = None


class FeederTable(Table):
    """The feeder."""

    capacitors: CapacitorsTable | None = None
    heaters: tuple[HeaterTable, ...] = ()
    cable: CableTable = CableTable()
    other_motor: OtherMotorTable | None = None
    neutral: bool = False
    ct_position: Literal["line", "inside-delta"] = "line"

    def feeder(self, motor: Motor) -> Feeder:
        """Return the feeder. Raises ValueError where the motor's connection does not allow it."""
        star = motor.nameplate.connection is Connection.STAR
        inside = self.ct_position == "inside-delta"
        if self.neutral and not star:
            raise ValueError("neutral: a delta has no star point")
        if inside and star:
            raise ValueError("ct_position: a star has no delta")
        other = None
        if self.other_motor is not None:
            since = self.other_motor.since_days
            since_s = -inf if since is None else SECONDS_PER_DAY * since
            other = OtherMotor(motor, Load(self.other_motor.load_level), since_s)
        return Feeder(
            capacitors=None if self.capacitors is None else self.capacitors.capacitors(),
            heaters=tuple(one.heater() for one in self.heaters),
            cable=Cable(self.cable.resistance_ohm, self.cable.reactance_ohm),
            other_motor=other,
            neutral=self.neutral,
            inside_delta=inside,
        )


class SaturationTable(Table):
    """How the main inductance follows the voltage."""

    loss_at_110: Annotated[float, Field(ge=0, le=0.4)]

    def saturation(self) -> MainSaturation:
        """Return the saturation whose main inductance at 110 % flux is less by this share."""
        over = 1.1 ** (EXPONENT - 1.0) - 1.0
        return MainSaturation(self.loss_at_110 / (1.0 - self.loss_at_110) / over)
