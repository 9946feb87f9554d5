"""Motors of many ratings whose file is wrong about them, with the sensors of their relays."""

from dataclasses import dataclass
from math import log, sqrt

import numpy as np

from benchmarks.condition.circuit import Array, Complex, Windings
from core.condition.observation import VoltageChannels
from core.machines.parameters import (
    MAGNETISING_OVER_SELF,
    Connection,
    MachineParameters,
    Motor,
    Nameplate,
)
from core.machines.sensors import SensorClass
from core.signals.sequence import PhaseSequence

LEAST_POWER_W, MOST_POWER_W = 800.0, 400_000.0
VOLTAGES_V = (380.0, 400.0, 480.0, 690.0)
ABC_SHARE = 0.6
SENSOR_CLASSES = (
    SensorClass(0.01, 0.01, 50e-6, 50e-6),
    SensorClass(0.01, 0.01, 25e-6, 25e-6),
    SensorClass(0.005, 0.005, 25e-6, 25e-6),
    SensorClass(0.002, 0.005, 10e-6, 25e-6),
)
TURNS_DEVIATION = 0.0007
"""Of a winding's effective turns: what a measured motor without a fault shows."""
RESISTANCE_DEVIATION, LEAKAGE_DEVIATION = 0.004, 0.01
"""Of a winding's own resistance and leakage from the others'."""


@dataclass(frozen=True, slots=True)
class Channels:
    """Complex ratios of the channels a, b, c (voltages of lines: ab, bc, ca), each (3,)."""

    voltage: Complex
    current: Complex


@dataclass(frozen=True, slots=True)
class SimulatedMotor:
    """A motor as its file says it is, and as it is.

    windings: at the temperature of the file's resistances.  saturation: relative loss of magnetising
    inductance per relative rise of the voltage.  sensors: the class of its channels.
    """

    motor: Motor
    windings: Windings
    saturation: float
    sequence: PhaseSequence
    voltage_channels: VoltageChannels
    sensors: SensorClass
    channels: Channels

    @property
    def delta(self) -> bool:
        return self.motor.nameplate.connection is Connection.DELTA

    @property
    def winding_voltage_V(self) -> float:
        """Rated voltage of a winding, peak."""
        line = sqrt(2.0) * self.motor.nameplate.rated_voltage_V
        return line if self.delta else line / sqrt(3.0)

    @property
    def rated_line_impedance_ohm(self) -> float:
        """Rated voltage of a line to neutral over the rated current, which is estimated."""
        nameplate = self.motor.nameplate
        return 0.75 * nameplate.rated_voltage_V**2 / nameplate.rated_power_W

    def terminal(self, winding: int) -> int:
        """Number under which the terminals know a winding of the machine's own frame."""
        if self.sequence is PhaseSequence.ABC:
            return winding
        return (2, 1, 0)[winding] if self.delta else (0, 2, 1)[winding]


@dataclass(frozen=True, slots=True)
class Site:
    """What motors of one bus have in common."""

    rated_voltage_V: float
    rated_frequency_Hz: float
    sequence: PhaseSequence


def draw_site(random: np.random.Generator) -> Site:
    """Draw a bus."""
    return Site(
        float(random.choice(VOLTAGES_V)),
        float(random.choice([50.0, 60.0])),
        PhaseSequence.ABC if random.uniform() < ABC_SHARE else PhaseSequence.ACB,
    )


def draw_motor(
    random: np.random.Generator,
    *,
    parameter_span: float = 0.1,
    sensors: SensorClass | None = None,
    site: Site | None = None,
) -> SimulatedMotor:
    """Draw a motor of any rating, powers log-uniform; each figure of its file is off by up to the span."""
    if site is None:
        site = draw_site(random)
    size = random.uniform()
    power = LEAST_POWER_W * (MOST_POWER_W / LEAST_POWER_W) ** size
    frequency, voltage = site.rated_frequency_Hz, site.rated_voltage_V
    delta = random.uniform() < 0.2 + 0.6 * size
    nameplate = Nameplate(
        rated_power_W=power,
        rated_voltage_V=voltage,
        rated_frequency_Hz=frequency,
        pole_pairs=int(random.integers(1, 4)),
        connection=Connection.DELTA if delta else Connection.STAR,
    )
    apparent = power / (0.70 + 0.14 * size)
    base = voltage**2 / apparent * (3.0 if delta else 1.0)
    w = nameplate.rated_angular_frequency
    R_s = base * _between(0.075, 0.008, size) * random.uniform(0.8, 1.2)
    R_r = R_s * random.uniform(0.8, 1.1)
    X_ls = base * 0.08 * np.exp(random.uniform(-0.3, 0.35))
    X_lr = X_ls * random.uniform(0.8, 1.3)
    X_m = base * _between(1.6, 3.5, size) * random.uniform(0.85, 1.15)
    skin = random.uniform(0.0, 0.2 + 0.8 * size)
    true = np.array([R_s, R_r, X_ls / w, X_lr / w, X_m / w])
    windings = draw_windings(random, true, w, skin)
    filed = true * random.uniform(1.0 - parameter_span, 1.0 + parameter_span, 5)
    sensor_class = sensors or SENSOR_CLASSES[int(random.integers(len(SENSOR_CLASSES)))]
    kinds = list(VoltageChannels)
    return SimulatedMotor(
        motor=motor_of(nameplate, filed, sensor_class),
        windings=windings,
        saturation=random.uniform(0.0, 1.5),
        sequence=site.sequence,
        voltage_channels=kinds[int(random.choice(3, p=[0.6, 0.2, 0.2]))],
        sensors=sensor_class,
        channels=draw_channels(random, sensor_class, frequency),
    )


def motor_of(nameplate: Nameplate, figures: Array, sensors: SensorClass) -> Motor:
    """Make a motor file of R_s, R_r, L_ls, L_lr and L_m."""
    R_s, R_r, L_ls, L_lr, L_m = (float(one) for one in figures)
    inertia = 0.02 * (nameplate.rated_power_W / 800.0) ** 1.2
    parameters = MachineParameters(R_s, R_r, L_ls, L_lr, L_m / MAGNETISING_OVER_SELF, inertia)
    return Motor("simulated", nameplate, parameters, sensors=sensors)


def draw_windings(random: np.random.Generator, figures: Array, w: float, skin: float) -> Windings:
    """Windings that differ a little; skin: how much more resistance the cage has at twice the frequency."""
    R_s, R_r, L_ls, L_lr, L_m = (np.array([one]) for one in figures)
    turns = random.normal(0.0, TURNS_DEVIATION, (1, 3))
    own = R_s * random.normal(0.0, RESISTANCE_DEVIATION, (1, 3)) + 1j * w * L_ls * random.normal(
        0.0, LEAKAGE_DEVIATION, (1, 3)
    )
    own -= own.mean()
    return Windings(
        R_s, R_r, L_ls, L_lr, L_m, 1.0 + turns - turns.mean(), own,
        np.array([1.0 + skin]), np.array([1.0 - 0.15 * skin]),
    )  # fmt: skip


def draw_channels(random: np.random.Generator, sensors: SensorClass, frequency: float) -> Channels:
    """Gains and delays of six channels, uniform within their class."""
    return Channels(
        voltage=_ratios(random, sensors.voltage_gain, sensors.voltage_delay_s, frequency),
        current=_ratios(random, sensors.current_gain, sensors.current_delay_s, frequency),
    )


def _ratios(random: np.random.Generator, gain: float, delay_s: float, frequency: float) -> Complex:
    delays = random.uniform(-delay_s, delay_s, 3)
    return np.asarray((1.0 + random.uniform(-gain, gain, 3)) * np.exp(-2j * np.pi * frequency * delays))


def _between(small: float, large: float, size: float) -> float:
    return float(np.exp(log(small) + size * (log(large) - log(small))))
