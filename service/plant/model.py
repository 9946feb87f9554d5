"""Sites, relays and motors as plain values."""

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
    """A motor relay: where it answers, and what its SCL promises of the references the service uses.

    trigger_control: control whose operation makes an event recording, "A1_SEL710CON/RBGGIO1.SPCSO01", None
    where there is none.
    record_made, fault_number: status the relay sets when a record is ready, None where it has none.
    report_control: buffered report "A1_SEL710CFG/LLN0.BR.BRep01" whose data set holds record_made, None
    where there is none.
    metering_data_set: data set with the measured currents, None where the relay offers none.
    measurands: what it measures all the time.
    expected: all that the SCL promises, to be compared with what the relay offers.
    overrides: what somebody has decided against all recognition.
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


@dataclass(frozen=True, slots=True)
class PlantMotor:
    """A motor where it stands: `motor` is what the diagnosis needs, `relay` the name of its relay.

    schedule: when it is recorded without anybody asking.
    """

    motor: Motor
    description: str
    site: str
    relay: str
    schedule: Schedule | None = None

    @property
    def name(self) -> str:
        return self.motor.name


@dataclass(frozen=True, slots=True)
class Plant:
    sites: tuple[Site, ...]
    relays: tuple[Relay, ...]
    motors: tuple[PlantMotor, ...]

    def motor(self, name: str) -> PlantMotor:
        """Raises KeyError for a motor the plant does not have."""
        return {motor.name: motor for motor in self.motors}[name]

    def relay(self, name: str) -> Relay:
        """Raises KeyError for a relay the plant does not have."""
        return {relay.name: relay for relay in self.relays}[name]

    def motor_of(self, relay: str) -> PlantMotor:
        """The motor a relay protects. Raises KeyError for a relay the plant does not have."""
        return {motor.relay: motor for motor in self.motors}[relay]
