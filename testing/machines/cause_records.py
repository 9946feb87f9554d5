"""Records of motors with one or two of the causes that are told apart, from the simulator's physics."""

from dataclasses import dataclass, replace
from math import pi, sqrt

import numpy as np

from core.diagnosis.causes import Cause, Causes
from core.machines.parameters import Motor, Nameplate
from core.recordings import Recording
from ied_sim.motor.eccentricity import Eccentricity
from ied_sim.motor.fault import FaultCourse
from ied_sim.motor.joint import JointCourse
from ied_sim.motor.load import Load, Pulsation
from ied_sim.motor.plant import MotorPlant, rated_current
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Harmonic, Supply
from testing.machines.disturbed_records import CHANNELS

STEP_RATE_HZ = 10_000.0
SETTLING_S = 2.0
BARS = 28
SOME_TIME_NS = 1_790_000_000_000_000_000


@dataclass(frozen=True, slots=True)
class Sizes:
    """How large each cause is where it is there; phases and channels are 0, 1, 2 for a, b, c.

    turns: shorted, of the phase, dead.  joint_drop: over a joint in a line at rated current, over the rated
    phase voltage.  unbalance: V2/V1.  voltage_error, current_error: relative, of one channel.  pulsation:
    over rated torque.  static, dynamic: eccentricities.  inductance_factor: L_s in the motor's file over that
    of the motor.
    """

    turns: float = 0.05
    turns_phase: int = 1
    bars: int = 1
    joint_drop: float = 0.08
    joint_phase: int = 2
    unbalance: complex = 0.03 + 0.01j
    voltage_error: float = 0.06
    voltage_channel: int = 0
    current_error: float = -0.04
    current_channel: int = 1
    pulsation: float = 0.06
    pulsation_hz: float = 4.1
    static: float = 0.3
    dynamic: float = 0.2
    inductance_factor: float = 0.7


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What a motor's records have besides: its supply, and the errors of its channels.

    gain_errors: of the six channels.  noise: over rated values, rms.
    """

    voltage_V: float
    frequency_hz: float
    unbalance: complex
    harmonics: tuple[Harmonic, ...]
    gain_errors: tuple[float, ...]
    noise: float

    @classmethod
    def drawn(cls, random: np.random.Generator, nameplate: Nameplate) -> "Surroundings":
        """Draw them.

        A voltage off by up to 3 %, 0.3 % of V2/V1, harmonics, channels anywhere within their class of +-1 %
        and noise of 0.1 to 0.5 % of rated.
        """
        return cls(
            unbalance=complex(0.003 * np.exp(2j * pi * random.uniform())),
            voltage_V=nameplate.rated_voltage_V * random.uniform(0.97, 1.03),
            frequency_hz=nameplate.rated_frequency_Hz + random.uniform(-0.05, 0.05),
            harmonics=tuple(
                Harmonic(order, random.uniform(0.0, 0.02), random.uniform(0.0, 2.0 * pi)) for order in (5, 7)
            ),
            gain_errors=tuple(random.uniform(-0.01, 0.01, 6).tolist()),
            noise=random.uniform(0.001, 0.005),
        )


@dataclass(frozen=True, slots=True)
class CauseCase:
    """A motor in steady running with causes; `nuisances` draws what every record has besides.

    Those are its `Surroundings`, and the motor's parameters within +-5 %.
    """

    motor: Motor
    causes: Causes
    load_level: float
    nuisances: int
    sizes: Sizes = Sizes()
    duration_s: float = 5.0
    sample_rate_hz: float = 4_000.0

    def record(self) -> Recording:
        """Return what the relay records."""
        random = np.random.default_rng([self.nuisances, 1])
        plant = self.plant(random)
        rate = self.sample_rate_hz
        true = plant.operation(0.0, self.duration_s, rate, settling_s=SETTLING_S, step_rate_hz=STEP_RATE_HZ)
        samples = np.vstack([true.currents_A, true.voltages_V])
        return Recording(
            plant.sensors.measure(samples, plant.rated_values, random), rate, SOME_TIME_NS, CHANNELS
        )

    def known(self) -> Motor:
        """Return the motor as its file knows it."""
        random = np.random.default_rng([self.nuisances, 2])
        machine = self.motor.parameters
        names = (
            "stator_resistance_ohm",
            "rotor_resistance_ohm",
            "stator_leakage_H",
            "rotor_leakage_H",
            "stator_self_inductance_H",
        )
        values = {name: getattr(machine, name) * (1.0 + random.uniform(-0.05, 0.05)) for name in names}
        if Cause.PARAMETERS in self.causes:
            values["stator_self_inductance_H"] = (
                machine.stator_self_inductance_H * self.sizes.inductance_factor
            )
        return replace(self.motor, parameters=replace(machine, **values))

    def plant(self, random: np.random.Generator) -> MotorPlant:
        """Return the simulated motor."""
        surroundings = Surroundings.drawn(random, self.motor.nameplate)
        return plant_with(
            self.causes, self.sizes, self.motor, self.load_level, surroundings, seed=self.nuisances
        )


def plant_with(
    causes: Causes,
    sizes: Sizes,
    motor: Motor,
    load_level: float,
    surroundings: Surroundings,
    *,
    seed: int,
) -> MotorPlant:
    """Return a simulated motor with causes; parameters that are wrong are those of its file."""
    nameplate = motor.nameplate
    unbalance = sizes.unbalance if Cause.SUPPLY in causes else surroundings.unbalance
    supply = Supply(
        surroundings.voltage_V,
        surroundings.frequency_hz,
        unbalance=abs(unbalance),
        unbalance_angle_rad=float(np.angle(unbalance)),
        harmonics=surroundings.harmonics,
    )
    swings = Cause.PULSATION in causes
    pulsations = (Pulsation(sizes.pulsation, frequency_Hz=sizes.pulsation_hz),) if swings else ()
    errors = list(surroundings.gain_errors)
    if Cause.CURRENT_CHANNEL in causes:
        errors[sizes.current_channel] += sizes.current_error
    if Cause.VOLTAGE_CHANNEL in causes:
        errors[3 + sizes.voltage_channel] += sizes.voltage_error
    plant = MotorPlant(
        motor,
        supply,
        Load(load_level, pulsations=pulsations),
        Sensors(
            10.0 * rated_current(motor),
            2.0 * nameplate.rated_voltage_V,
            gain_errors=tuple(errors),
            noise=surroundings.noise,
        ),
        seed=seed,
    )
    if Cause.SHORTED_TURNS in causes:
        plant = replace(plant, fault=FaultCourse(sizes.turns_phase, ((0.0, sizes.turns),)))
    if Cause.ROTOR in causes:
        plant = replace(plant, broken_bars=sizes.bars / BARS)
    if Cause.CONNECTION in causes:
        phase_V = nameplate.rated_voltage_V / sqrt(3.0)
        resistance_ohm = sizes.joint_drop * phase_V / rated_current(motor)
        plant = replace(plant, joint=JointCourse(sizes.joint_phase, ((0.0, resistance_ohm),)))
    if Cause.ECCENTRICITY in causes:
        plant = replace(plant, eccentricity=Eccentricity(sizes.static, sizes.dynamic))
    return plant
