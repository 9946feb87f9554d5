"""Sites, relays, motors and buses as plain values."""

from dataclasses import dataclass, field

from core.machines.parameters import Motor
from service.plant.metering import Measurand
from service.plant.offer import Offer
from service.plant.overrides import AS_RECOGNISED, Overrides
from service.plant.schedule import Schedule


@dataclass(frozen=True, slots=True)
class Site:
    name: str
    description: str


@dataclass(frozen=True, slots=True)
class Relay:
    """A motor relay: its address, and the references of its SCL that the service uses.

    trigger_control: control whose operation makes an event recording, "A1_SEL710CON/RBGGIO1.SPCSO01", None
    where there is none.
    record_made, fault_number: status the relay sets when a record is ready, None where it has none.
    report_control: buffered report "A1_SEL710CFG/LLN0.BR.BRep01" whose data set holds record_made, None
    where there is none.
    metering_data_set: data set with the measured currents, None where the relay offers none.
    measurands: what it measures all the time.
    expected: all that the SCL describes, for comparison with what the relay offers.
    overrides: what the motors file says instead of what would be recognised.
    time_zone: IANA name of the zone in which its clock runs; None for UTC.
    scl_knows_names: whether the SCL knows how its logical devices are called; an ICD does not.
    """

    name: str
    site: str
    host: str
    port: int
    manufacturer: str
    type: str
    trigger_control: str | None
    record_made: str | None
    fault_number: str | None
    report_control: str | None
    metering_data_set: str | None
    measurands: tuple[Measurand, ...] = ()
    expected: Offer | None = field(default=None, compare=False, repr=False)
    overrides: Overrides = AS_RECOGNISED
    time_zone: str | None = None
    scl_knows_names: bool = True


@dataclass(frozen=True, slots=True)
class PlantMotor:
    """A motor at its place in the plant.

    motor: its data for the diagnosis.
    relay: name of the relay that protects it.
    schedule: when it is recorded regularly; None where it is not.
    bus: name of the bus it is fed from; None where that is not known.
    long_record_days, long_record_s: how often it is recorded for long [days], and how long [s]; None where
    the settings decide.
    """

    motor: Motor
    description: str
    site: str
    relay: str
    schedule: Schedule | None = None
    bus: str | None = None
    long_record_days: float | None = None
    long_record_s: float | None = None

    @property
    def name(self) -> str:
        return self.motor.name


@dataclass(frozen=True, slots=True)
class Bus:
    """A bus with the motors that it feeds: their relays see the same supply.

    motors: names of its motors.
    schedule: when all of them are recorded, at once; None where they are not.
    common_voltage_transformer: whether all relays have their voltages from one transformer, whose errors they
    share; otherwise each has its own.
    """

    name: str
    motors: tuple[str, ...]
    schedule: Schedule | None = None
    common_voltage_transformer: bool = False


@dataclass(frozen=True, slots=True)
class Plant:
    sites: tuple[Site, ...]
    relays: tuple[Relay, ...]
    motors: tuple[PlantMotor, ...]
    buses: tuple[Bus, ...] = ()

    def motor(self, name: str) -> PlantMotor:
        """Return a motor by its name. Raises KeyError."""
        return {motor.name: motor for motor in self.motors}[name]

    def bus_of(self, motor: str) -> Bus | None:
        """Return the bus that feeds a motor; None where it is not known."""
        return next((bus for bus in self.buses if motor in bus.motors), None)

    def relay(self, name: str) -> Relay:
        """Return a relay by its name. Raises KeyError."""
        return {relay.name: relay for relay in self.relays}[name]

    def time_zones(self) -> dict[str, str]:
        """Return the zones of the relays' clocks that do not run in UTC, by motor."""
        zones = {relay.name: relay.time_zone for relay in self.relays if relay.time_zone is not None}
        return {motor.name: zones[motor.relay] for motor in self.motors if motor.relay in zones}

    def motor_of(self, relay: str) -> PlantMotor:
        """Return the motor that a relay protects. Raises KeyError."""
        return {motor.relay: motor for motor in self.motors}[relay]
