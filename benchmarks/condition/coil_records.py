"""Steady states of a motor with turns shorted in one coil, in closed form, as its relay measures them.

The currents are those of `core.machines.coil_fault`, which is checked against other physics elsewhere; what
the estimator does not know is drawn: path and share of the leakage, an axis beside that of the table, a
misfit of the fault's change of each current, parameters, temperature, saturation, channels and supply.
"""

from dataclasses import dataclass, replace
from enum import StrEnum
from math import degrees, pi, radians, sqrt

import numpy as np

from core.condition.observation import Observation, VoltageChannels
from core.machines.coil_fault import SequencePair, air_gap, faulty_currents
from core.machines.parameters import Connection, MachineParameters, Motor, Nameplate, ParameterTolerances
from core.machines.sensors import SensorClass
from core.machines.stator_winding import StatorWinding, WindingKind
from core.signals.sequence import PhaseSequence

A = np.exp(2j * pi / 3.0)
HOUR_NS = 3_600_000_000_000
FREQUENCY_HZ = 50.0
W = 2.0 * pi * FREQUENCY_HZ
SENSORS = SensorClass(0.01, 0.01, 25e-6, 25e-6)
MISFIT = 0.04
AXIS_ASTRAY_DEG = 3.0
INSIDE_ONE_COIL = 0.6
"""Share of faults inside one coil that fill its slots; the others have any leakage up to 1."""
NEAR_COIL = (1.2, 0.3)
"""Median of c, and standard deviation of its logarithm."""

SMALL = Motor(
    "0.8 kW",
    Nameplate(800.0, 380.0, FREQUENCY_HZ, 2),
    MachineParameters(8.4, 8.2, 0.0328, 0.0328, 0.4377, 0.0229),
    sensors=SENSORS,
)
MEDIUM = Motor(
    "7.5 kW",
    Nameplate(7_500.0, 400.0, FREQUENCY_HZ, 2),
    MachineParameters(0.7384, 0.7402, 0.003045, 0.003045, 0.08273, 0.0343),
    sensors=SENSORS,
)
LARGE = Motor(
    "160 kW",
    Nameplate(160_000.0, 400.0, FREQUENCY_HZ, 2, Connection.DELTA),
    MachineParameters(0.042, 0.03, 0.0006, 0.0006, 0.0165, 2.9),
    sensors=SENSORS,
)
MOTORS = (SMALL, MEDIUM, LARGE)
WINDINGS = (
    StatorWinding(WindingKind.LAP, 36, 2, 8),
    StatorWinding(WindingKind.LAP, 48, 2, 10),
    StatorWinding(WindingKind.LAP, 24, 2, 5),
    StatorWinding(WindingKind.CONCENTRIC, 36, 1),
)


class Kind(StrEnum):
    """What becomes of a motor after its reference."""

    HEALTHY = "nothing"
    TURNS = "shorted turns"
    VOLTAGE = "voltage channel"
    CURRENT = "current channel"
    JOINT = "joint"
    ASYMMETRY = "unknown asymmetry"


@dataclass(frozen=True, slots=True)
class Setting:
    """What the records of a motor are like. load: share of rated slip.

    winding_known: whether the motor's file has its winding.  zero_voltage: whether V0 is measured.
    inductance: scatter of X_m from record to record.  noise: of every channel, over V1.
    most_path: of the path over the turns' own resistance.
    """

    name: str
    load: tuple[float, float] = (0.3, 1.0)
    winding_known: bool = False
    zero_voltage: bool = True
    inductance: float = 0.005
    noise: float = 3e-4
    swing: float = 0.0
    inside_one_coil: bool = False
    most_path: float = 8.0


@dataclass(frozen=True, slots=True)
class Truth:
    """A motor and what is wrong with it. axis_deg: of the coil, at the terminals of an a-b-c supply.

    size: equivalent level, error of the channel, drop of the joint at rated current, or share of V1.
    """

    motor: Motor
    kind: Kind
    winding: int
    size: float
    axis_deg: float
    records: list[Observation]
    sequence: PhaseSequence


def records_of(
    setting: Setting, motor: Motor, kind: Kind, size: float, seed: list[int], before: int, after: int
) -> Truth:
    """Draw a motor, a reference, and what comes after it."""
    random = np.random.default_rng(seed)
    drawn = _Plant(setting, motor, random)
    records = [drawn.record(Kind.HEALTHY, 0.0) for _ in range(before)]
    records += [drawn.record(kind, size) for _ in range(after)]
    known = replace(motor, parameters=drawn.filed)
    if setting.winding_known:
        known = replace(known, winding=drawn.winding_data)
    return Truth(known, kind, drawn.terminal, size, drawn.table_deg, records, drawn.sequence)


class _Plant:
    def __init__(self, setting: Setting, motor: Motor, random: np.random.Generator) -> None:
        self.setting, self.motor, self.random = setting, motor, random
        true = motor.parameters
        off = 1.0 + random.uniform(-0.1, 0.1, 5)
        wrong = {
            name: float(factor * getattr(true, name))
            for name, factor in zip(ParameterTolerances.names(), off.tolist(), strict=True)
        }
        self.filed = replace(true, **wrong)
        self.sequence = PhaseSequence.ABC if random.uniform() < 0.5 else PhaseSequence.ACB
        self.winding_data = WINDINGS[int(random.integers(len(WINDINGS)))]
        axes = self.winding_data.coil_axes(motor.nameplate.pole_pairs)
        axis = axes[int(random.integers(len(axes)))]
        self.table_deg = degrees(axis.angle_rad)
        sign = 1.0 if self.sequence is PhaseSequence.ABC else -1.0
        angle = radians(self.table_deg + AXIS_ASTRAY_DEG * random.normal())
        self.ahead = axis.linkage * complex(np.exp(1j * sign * angle))
        self.path = float(random.uniform(0.0, setting.most_path)) * float(random.uniform() < 0.7)
        c = NEAR_COIL[0] * np.exp(NEAR_COIL[1] * random.normal())
        if self.winding_data.layers == 1:
            c *= 1.5
        self.own_leakage = c * self.winding_data.coils_per_phase
        self.winding = int(random.integers(3))
        self.delta = motor.nameplate.connection is Connection.DELTA
        mirrored = self.sequence is PhaseSequence.ACB
        self.terminal = ((2, 1, 0) if self.delta else (0, 2, 1))[self.winding] if mirrored else self.winding
        self.misfit = 1.0 + MISFIT * (random.normal(size=2) + 1j * random.normal(size=2)) / sqrt(2.0)
        self.gains = 1.0 + random.uniform(-0.01, 0.01, (2, 3)) * np.exp(
            1j * random.uniform(-1.0, 1.0, (2, 3)) * 0.0
        )
        self.gains = self.gains * np.exp(-1j * W * random.uniform(-25e-6, 25e-6, (2, 3)))
        self.own = 1e-3 * complex(*random.normal(size=2))
        self.saturation = float(random.uniform(0.0, 1.5))
        self.error = complex(1.0, 0.2 * random.normal()) * (1 if random.uniform() < 0.5 else -1)
        self.asymmetry = complex(np.exp(2j * pi * random.uniform()))
        self.unbalance = random.uniform(0.0, 0.012) * complex(np.exp(2j * pi * random.uniform()))
        self.middle = float(random.uniform(0.4, 0.9))
        inside = setting.inside_one_coil or random.uniform() < INSIDE_ONE_COIL
        self.free_leakage = None if inside else float(random.uniform(0.0, 1.0))
        self.warmth, self.wander, self.time_ns = 0.0, 0j, 0

    def leakage(self, level: float) -> float:
        """Return psi of shorted turns."""
        if self.free_leakage is not None:
            return self.free_leakage
        mu = level * (1.0 + self.path)
        kappa = min(1.0, self.own_leakage * mu)
        return float((kappa + (1.0 - kappa) * mu) / (1.0 + self.path))

    def record(self, kind: Kind, size: float) -> Observation:
        """Return the next hourly record."""
        random, machine, setting = self.random, self.motor.parameters, self.setting
        self.time_ns += HOUR_NS
        kept = np.exp(-1.0 / 3.0)
        self.warmth = kept * self.warmth + sqrt(1.0 - kept**2) * 0.08 * random.normal()
        self.wander = 0.9 * self.wander + 0.44 * 0.002 * complex(*random.normal(size=2))
        warm = 1.1 + self.warmth
        load = random.uniform(*setting.load)
        if setting.swing:
            load = self.middle * (1.0 + setting.swing * random.uniform(-1.0, 1.0))
        voltage = 1.0 + 0.01 * random.normal()
        inductance = 1.0 - self.saturation * (voltage - 1.0) + setting.inductance * random.normal()
        plate = self.motor.nameplate
        R_s, R_r = machine.stator_resistance_ohm * warm, machine.rotor_resistance_ohm * warm
        volts_rms = plate.rated_voltage_V / (1.0 if self.delta else sqrt(3.0))
        slip = load * R_r * plate.rated_power_W / (3.0 * volts_rms**2) * 1.15
        gap = air_gap(
            complex(R_s, W * machine.stator_leakage_H), W * machine.magnetising_inductance_H * inductance,
            R_r, W * machine.rotor_leakage_H, slip,
        )  # fmt: skip
        v1 = volts_rms * sqrt(2.0) * voltage + 0j
        v2 = v1 * (self.unbalance + self.wander)
        i1, i2 = v1 / (gap.stator + gap.forward), (v2 - self.own * v1) / (gap.stator + gap.backward)
        if kind is Kind.TURNS:
            branch = complex(R_s, self.leakage(size) * gap.stator.imag) / size
            circulating = 1.0 / 3.0 if self.delta else 0.0
            found = faulty_currents(
                gap,
                SequencePair(v1, v2),
                branch,
                self.ahead,
                self.ahead.conjugate(),
                circulating,
                self.winding,
            )
            i1 += self.misfit[0] * (found.positive - v1 / (gap.stator + gap.forward))
            i2 += self.misfit[1] * (found.negative - v2 / (gap.stator + gap.backward))
        elif kind is Kind.ASYMMETRY:
            i2 -= size * self.asymmetry * v1 / (gap.stator + gap.backward)
        elif kind is Kind.JOINT:
            rated = plate.rated_power_W / (3.0 * volts_rms * 0.75) * sqrt(2.0)
            ohm = size * volts_rms * sqrt(2.0) / rated
            i1 = v1 / (gap.stator + gap.forward + ohm / 3.0)
            i2 -= A**self.winding * ohm / 3.0 * i1 / (gap.stator + gap.backward)
        return self._measured(v1, v2, i1, i2, kind, size)

    def _measured(
        self, v1: complex, v2: complex, i1: complex, i2: complex, kind: Kind, size: float
    ) -> Observation:
        """Send the windings' phasors through the channels of the terminals."""
        turn, root = np.exp(1j * pi / 6.0), sqrt(3.0)
        if self.delta:
            v1, v2, i1, i2 = v1 / (root * turn), v2 / root * turn, i1 * root / turn, i2 * root * turn
        voltage, current = self._phases(v1, v2, 0.004 * v1 + 0.2 * v2), self._phases(i1, i2, 0j)
        volts, amperes = self.gains.copy()
        if kind is Kind.VOLTAGE:
            volts[self.winding] *= 1.0 + size * self.error
        elif kind is Kind.CURRENT:
            amperes[self.winding] *= 1.0 + size * self.error
        noise = self.setting.noise
        scale = abs(v1) * np.sqrt(0.5)
        impedance = abs(v1) / abs(i1) * 0.15
        zero = None
        channels = VoltageChannels.PHASE
        seen_current = current * amperes + noise * scale / impedance * 0.15 * self._white()
        seen_voltage = voltage * volts + noise * scale * self._white()
        if not self.setting.zero_voltage:
            channels = VoltageChannels.THREE_LINES
            lines = voltage - np.roll(voltage, -1)
            lines = lines * volts + noise * scale * root * self._white()
            V1, V2 = self._of_lines(lines)
        else:
            V1, V2 = self._sequences(seen_voltage)
            zero = complex(seen_voltage.mean())
        I1, I2 = self._sequences(seen_current)
        if self.delta:
            V1, V2, I1, I2 = V1 * root * turn, V2 * root / turn, I1 / root * turn, I2 / root / turn
        return Observation(
            time_ns=self.time_ns, recorder="relay", sequence=self.sequence, voltage_channels=channels,
            frequency_hz=FREQUENCY_HZ, positive_voltage_V=complex(V1), negative_voltage_V=complex(V2),
            zero_voltage_V=zero, positive_current_A=complex(I1), negative_current_A=complex(I2),
            zero_current_A=complex(seen_current.mean()), scatter=2.0 / 3.0 * noise**2, cycles=25,
        )  # fmt: skip

    def _phases(self, x1: complex, x2: complex, x0: complex) -> np.ndarray:
        machine = np.array([x1 / A**k + x2 * A**k + x0 for k in range(3)])
        return machine if self.sequence is PhaseSequence.ABC else machine[[0, 2, 1]]

    def _sequences(self, x: np.ndarray) -> tuple[complex, complex]:
        own = x if self.sequence is PhaseSequence.ABC else x[[0, 2, 1]]
        k = np.arange(3)
        return complex((own * A**k).sum() / 3.0), complex((own / A**k).sum() / 3.0)

    def _of_lines(self, lines: np.ndarray) -> tuple[complex, complex]:
        """Return the sequences that alpha and beta of three line voltages give."""
        alpha, beta = (lines[0] - lines[2]) / 3.0, lines[1] / sqrt(3.0)
        if self.sequence is PhaseSequence.ACB:
            beta = -beta
        return complex(alpha + 1j * beta) / 2.0, complex(alpha - 1j * beta) / 2.0

    def _white(self) -> np.ndarray:
        parts = self.random.normal(size=(2, 3))
        return np.asarray((parts[0] + 1j * parts[1]) / sqrt(2.0))
