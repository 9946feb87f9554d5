"""A motor's records in closed form: what the filter should find in them is known."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from core.condition.filter.state import ComplexArray
from core.condition.following.follower import Follower
from core.condition.observation import Observation, VoltageChannels
from core.machines.coil_fault import AirGap, SequencePair, air_gap, faulty_currents
from core.machines.parameters import Connection, MachineParameters, Motor, Nameplate
from core.machines.sensors import SensorClass
from core.machines.winding_frame import to_winding_frame
from core.signals.sequence import PhaseSequence

HOUR_NS = 3600 * 10**9
PARAMETERS = MachineParameters(8.4, 8.2, 0.0328, 0.0328, 0.4377, 0.0229)
A = np.exp(2j * np.pi / 3.0)
RATED_V = 310.0
WARM = 1.12
W = 2.0 * np.pi * 50.0
Z2 = complex(14.9, 20.8)


def motor_of(connection: Connection = Connection.STAR) -> Motor:
    """The thesis's motor."""
    plate = Nameplate(800.0, 380.0, 50.0, 2, connection)
    return Motor("P-101", plate, PARAMETERS, sensors=SensorClass(0.01, 0.01, 25e-6, 25e-6))


@dataclass
class Plant:
    """A motor, its channels and what is wrong with them; all may be changed between records."""

    connection: Connection = Connection.STAR
    sequence: PhaseSequence = PhaseSequence.ABC
    noise: float = 2e-4
    seed: int = 0
    level: float = 0.0
    winding: int = 0
    path: float = 1.0
    axis_deg: float = 0.0
    linkage: float = 1.0
    kappa: float = 0.3
    """Share of the leakage that stays with the shorted turns."""
    asymmetry: complex = 0j
    """Of unknown cause, a share of V1: of the winding's voltage that drives no negative current."""
    joint_ohm: float = 0.0
    joint: int = 0
    voltage: list[complex] = field(default_factory=lambda: [1.004, 0.997, 1.001 + 0.003j])
    current: list[complex] = field(default_factory=lambda: [0.996, 1.002 + 0.002j, 1.003])
    unbalance: complex = 0.008 + 0.003j
    supply_swing: float = 0.003
    load: tuple[float, float] = (0.6, 0.9)
    scale: float = 1.0
    """Factor of all voltages and currents."""
    with_zero_voltage: bool = True
    elements: list[complex] = field(default_factory=lambda: [0j, 0j, 0j])
    """Admittances between the terminals a-b, b-c and c-a behind the transformers, beside the motor [S]."""
    others: float = 0.0
    """Size of another motor on the same terminals over that of the first."""

    def __post_init__(self) -> None:
        self.random = np.random.default_rng(self.seed)
        self.time_ns = 0
        self.swing = 0j

    def record(self) -> Observation:
        """The next hourly record."""
        random = self.random
        self.swing = 0.9 * self.swing + self.supply_swing * 0.4 * complex(*random.normal(size=2))
        v1, v2 = RATED_V, RATED_V * (self.unbalance + self.swing)
        backward = self.backward_impedance()
        slip = 0.11 * random.uniform(*self.load)
        # In the machine's own frame, positive sequence; windings of a delta see the line voltages.
        turn = np.exp(1j * np.pi / 6.0)
        delta = self.connection is Connection.DELTA
        if delta:
            v1, v2 = v1 * np.sqrt(3.0) * turn, v2 * np.sqrt(3.0) / turn
        gap = air_gap(
            complex(WARM * PARAMETERS.stator_resistance_ohm, W * PARAMETERS.stator_leakage_H),
            W * PARAMETERS.magnetising_inductance_H, WARM * PARAMETERS.rotor_resistance_ohm,
            W * PARAMETERS.rotor_leakage_H, slip,
        )  # fmt: skip
        i1, i2 = v1 / (gap.stator + gap.forward), (v2 - self.asymmetry * v1) / backward
        more = self.turns_current(gap, v1)
        i1, i2 = i1 + more.positive, i2 + more.negative
        i1 -= self.joint_ohm / 3.0 * i1 / (gap.stator + gap.forward)
        i2 -= A**self.joint / 3.0 * self.joint_ohm * i1 / backward
        if delta:
            v1, v2 = v1 / (np.sqrt(3.0) * turn), v2 / np.sqrt(3.0) * turn
            i1, i2 = i1 * np.sqrt(3.0) / turn, i2 * np.sqrt(3.0) * turn
        if self.others:
            i1, i2 = (
                (1.0 + 0.9 * self.others) * i1,
                i2 + 1.1 * self.others * v2 / Z2 * (3.0 if delta else 1.0),
            )
        voltage = self._phases(v1, v2, 0.005 * RATED_V + 0.2 * v2)
        current = (self._phases(i1, i2, 0.0) + self._beside(voltage)) * np.array(self.current)
        voltage = voltage * np.array(self.voltage)
        voltage = voltage + self.noise * RATED_V * self._white()
        current = current + self.noise * self._white()
        return self._observation(voltage * self.scale, current * self.scale)

    def _beside(self, voltage: ComplexArray) -> ComplexArray:
        """Currents of the elements between the terminals."""
        between = np.array(self.elements) * (voltage - np.roll(voltage, -1))
        return np.asarray(between - np.roll(between, 1))

    def turns_current(self, gap: AirGap, v1: complex) -> SequencePair:
        """What the shorted turns draw: equivalent level m = mu / (1 + p), psi = lambda / (1 + p)."""
        if self.level == 0.0:
            return SequencePair(0j, 0j)
        turns = self.level * (1.0 + self.path)
        psi = (self.kappa + (1.0 - self.kappa) * turns) / (1.0 + self.path)
        branch = complex(gap.stator.real, psi * gap.stator.imag) / self.level
        sign = 1.0 if self.sequence is PhaseSequence.ABC else -1.0
        ahead = self.linkage * complex(np.exp(1j * sign * np.radians(self.axis_deg)))
        seen = SequencePair(complex(v1), 0j)
        found = faulty_currents(gap, seen, branch, ahead, ahead.conjugate(), 0.0, self.winding)
        return SequencePair(found.positive - v1 / (gap.stator + gap.forward), found.negative)

    def backward_impedance(self) -> complex:
        """Negative-sequence impedance at the next record [ohm]."""
        return Z2 * (1.0 + 0.03 * self.random.normal())

    def records(self, count: int) -> list[Observation]:
        """So many records in a row."""
        return [self.record() for _ in range(count)]

    def _phases(self, x1: complex, x2: complex, x0: complex) -> ComplexArray:
        machine = np.array([x1 / A**k + x2 * A**k + x0 for k in range(3)])
        return machine if self.sequence is PhaseSequence.ABC else machine[[0, 2, 1]]

    def _white(self) -> ComplexArray:
        parts = self.random.normal(size=(2, 3)) / np.sqrt(2.0)
        return np.asarray(parts[0] + 1j * parts[1])

    def _observation(self, voltage: ComplexArray, current: ComplexArray) -> Observation:
        self.time_ns += HOUR_NS
        (i1, i2), (v1, v2) = (self._windings(current, voltage, k) for k in range(2))
        return Observation(
            time_ns=self.time_ns, recorder="relay", sequence=self.sequence,
            voltage_channels=VoltageChannels.PHASE, frequency_hz=50.0,
            positive_voltage_V=v1, negative_voltage_V=v2,
            zero_voltage_V=complex(voltage.mean()) if self.with_zero_voltage else None,
            positive_current_A=i1, negative_current_A=i2, zero_current_A=complex(current.mean()),
            scatter=2.0 / 3.0 * self.noise**2, cycles=20,
        )  # fmt: skip

    def _windings(self, current: ComplexArray, voltage: ComplexArray, which: int) -> tuple[complex, complex]:
        """Both sequences of the windings, by way of the instants that `to_winding_frame` turns."""
        angles = 2.0 * np.pi / 16.0 * np.arange(16)
        clarke = np.sqrt(2.0 / 3.0) * np.array([[1.0, -0.5, -0.5], [0.0, np.sqrt(0.75), -np.sqrt(0.75)]])
        i_ab, v_ab = (clarke @ np.real(x[:, None] * np.exp(1j * angles)) for x in (current, voltage))
        turned = to_winding_frame(i_ab, v_ab, self.sequence, self.connection)[which]
        vector = (turned[0] + 1j * turned[1]) * np.sqrt(2.0 / 3.0)
        forward = complex(np.mean(vector * np.exp(-1j * angles)))
        backward = complex(np.mean(vector * np.exp(1j * angles)))
        return forward, backward.conjugate()


def follow(motor: Motor, records: Sequence[Observation]) -> Follower:
    """Fold records one by one."""
    follower = Follower(motor)
    for record in records:
        follower.fold(record)
    return follower
