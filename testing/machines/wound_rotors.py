"""A motor with a wound rotor, and its records from the simulator's own physics."""

from dataclasses import dataclass, field, replace

from core.machines.parameters import MachineParameters, Motor, Nameplate, WoundRotor
from core.recordings import Recording
from ied_sim.motor.contactor import Contactor
from ied_sim.motor.fault import FaultCourse
from ied_sim.motor.load import Load, Pulsation
from ied_sim.motor.plant import MotorPlant, rated_current
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.slip_rings import SlipRings, turns_ratio
from ied_sim.motor.supply import Supply
from testing.machines.disturbed_records import record_of

SAMPLE_RATE_HZ = 5_000.0
ROTOR = WoundRotor(open_circuit_voltage_V=240.0, rated_current_A=98.0)
HOIST = Motor(
    "hoist",
    Nameplate(37_000.0, 400.0, 50.0, pole_pairs=2, rated_speed_rpm=1464.0),
    MachineParameters(0.085, 0.0880, 0.00075, 0.00085, 0.0175, 0.9),
    wound_rotor=ROTOR,
)
"""37 kW with its rings shorted while it runs."""
MILL = Motor(
    "mill",
    Nameplate(500_000.0, 6_000.0, 50.0, pole_pairs=3, rated_speed_rpm=989.0),
    MachineParameters(0.65, 0.70, 0.0206, 0.0219, 0.535, 100.0),
    wound_rotor=WoundRotor(open_circuit_voltage_V=1_100.0, rated_current_A=281.0),
)
"""500 kW at medium voltage."""
HOIST_WITH_UNKNOWN_RESISTANCE = replace(
    HOIST, wound_rotor=replace(ROTOR, external_resistance_ohm=(0.0, 0.35))
)
"""The same behind a liquid starter whose position nobody records."""


@dataclass(frozen=True, slots=True)
class WoundRotorCase:
    """A motor with a wound rotor in one operation.

    external_ohm: at the rings while it runs.  contacts_ohm: what bad contacts add to each rotor phase.
    level, phase: shorted turns.  noise: white, of rated values.  start_steps, start_ends_s: of a start.
    gain_errors: of the six channels.
    """

    motor: Motor = HOIST
    load_level: float = 0.6
    external_ohm: float = 0.0
    contacts_ohm: tuple[float, float, float] = (0.0, 0.0, 0.0)
    level: float = 0.0
    phase: int = 1
    unbalance: float = 0.005
    unbalance_angle_rad: float = 0.0
    pulsations: tuple[Pulsation, ...] = ()
    noise: float = 0.002
    seed: int = 0
    start_steps: tuple[tuple[float, float], ...] = ()
    start_ends_s: float = 0.0
    inertia_kgm2: float = 0.0
    gain_errors: tuple[float, ...] = field(default=(0.0,) * 6)

    @property
    def plant(self) -> MotorPlant:
        """The simulated motor, which runs."""
        motor, volts, rotor = self.motor, self.motor.nameplate.rated_voltage_V, self.motor.wound_rotor
        assert rotor is not None
        return MotorPlant(
            motor,
            Supply(
                volts,
                motor.nameplate.rated_frequency_Hz,
                unbalance=self.unbalance,
                unbalance_angle_rad=self.unbalance_angle_rad,
            ),
            Load(self.load_level, pulsations=self.pulsations, inertia_kgm2=self.inertia_kgm2),
            Sensors(12.0 * rated_current(motor), 2.0 * volts, self.gain_errors, noise=self.noise),
            fault=FaultCourse(self.phase, ((0.0, self.level),), 0.0) if self.level else None,
            seed=self.seed,
            slip_rings=SlipRings(
                turns_ratio(motor, rotor.open_circuit_voltage_V),
                self.contacts_ohm,
                self.external_ohm,
                self.start_steps,
                self.start_ends_s,
            ),
        )

    def record(self, duration_s: float) -> Recording:
        """What a relay records of the running motor."""
        return record_of(self.plant.window(0.0, duration_s, SAMPLE_RATE_HZ), SAMPLE_RATE_HZ)

    def slip(self) -> float:
        """Mean slip, from the simulated speed over a second."""
        nameplate = self.motor.nameplate
        speed = self.plant.operation(0.0, 1.0, 1_000.0).speed_rad_s
        return 1.0 - float(speed.mean()) * nameplate.pole_pairs / nameplate.rated_angular_frequency

    def start(self, duration_s: float, switched_on_s: float = 0.1) -> Recording:
        """What a relay records of a start, switched on so long after the record's beginning."""
        contactor = Contactor(open_at_first=True)
        contactor.close(switched_on_s)
        plant = replace(self.plant, contactor=contactor)
        return record_of(plant.window(0.0, duration_s, SAMPLE_RATE_HZ), SAMPLE_RATE_HZ)
