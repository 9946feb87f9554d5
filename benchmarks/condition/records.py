"""Observations of a simulated motor: what its relay measures, in bulk."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from benchmarks.condition.circuit import Array, Complex, Shorted, running
from benchmarks.condition.courses import Course
from benchmarks.condition.operation import Operation
from benchmarks.condition.population import SimulatedMotor
from core.condition.observation import Observation, VoltageChannels
from core.signals.sequence import PhaseSequence

REAL_NOISE, HARSH_NOISE = 2e-4, 2e-3
"""Of a channel's phasor from record to record, over V1 (currents: over V1 / |Z2|), root mean square."""
RECORD_CYCLES = 25
OUTLIER = 10.0
"""Times the noise of other records."""
SCATTER_SPAN = (0.1, 1.5)
"""What the record's own noise says over the variance from record to record."""

TERMINALS = {PhaseSequence.ABC: [0, 1, 2], PhaseSequence.ACB: [0, 2, 1]}
"""The machine's lines on terminals a, b, c."""
CLARKE = np.sqrt(2 / 3) * np.array([[1, -0.5, -0.5], [0, np.sqrt(3) / 2, -np.sqrt(3) / 2]])
CLARKE_OF_LINES = np.array([[np.sqrt(1 / 6), 0, -np.sqrt(1 / 6)], [0, np.sqrt(1 / 2), 0]])


@dataclass(frozen=True, slots=True)
class Measured:
    """Phasors of the windings as the relay sees them, peak, one row a record; see `Observation`."""

    time_ns: NDArray[np.int64]
    recorder: NDArray[np.int64]
    frequency_hz: Array
    positive_voltage_V: Complex
    negative_voltage_V: Complex
    zero_voltage_V: Complex
    positive_current_A: Complex
    negative_current_A: Complex
    zero_current_A: Complex
    scatter: Array
    load: Array
    sequence: PhaseSequence
    voltage_channels: VoltageChannels

    def __len__(self) -> int:
        return self.time_ns.size

    def observations(self) -> list[Observation]:
        """One a record, in the order of time."""
        with_zero = self.voltage_channels is VoltageChannels.PHASE
        zero_voltages: list[complex] | list[None] = (
            self.zero_voltage_V.tolist() if with_zero else [None] * len(self)
        )
        columns = (
            self.time_ns, self.recorder, self.frequency_hz, self.positive_voltage_V, self.negative_voltage_V,
            self.positive_current_A, self.negative_current_A, self.zero_current_A, self.scatter, self.load,
        )  # fmt: skip
        rows = zip(*(column.tolist() for column in columns), zero_voltages, strict=True)
        return [
            Observation(
                time_ns=time, recorder=f"relay {recorder}", sequence=self.sequence,
                voltage_channels=self.voltage_channels, frequency_hz=frequency,
                positive_voltage_V=V1, negative_voltage_V=V2, zero_voltage_V=V0,
                positive_current_A=I1, negative_current_A=I2, zero_current_A=I0,
                scatter=scatter, cycles=RECORD_CYCLES, load_level=load,
            )
            for time, recorder, frequency, V1, V2, I1, I2, I0, scatter, load, V0 in rows
        ]  # fmt: skip


def true_phasors(simulated: SimulatedMotor, operation: Operation, course: Course) -> tuple[Complex, Complex]:
    """Line-to-neutral voltages and line currents of terminals a, b, c, peak, each (n, 3)."""
    nameplate = simulated.motor.nameplate
    n = len(operation)
    rated_V = np.sqrt(2 / 3) * nameplate.rated_voltage_V
    supply = Operation(
        operation.time_ns, operation.load, operation.warming, operation.relative_voltage,
        operation.unbalance + course.unbalance, operation.displacement, operation.frequency_ratio,
    )  # fmt: skip
    voltage = supply.phase_voltages(rated_V)
    windings = simulated.windings
    if course.rewound is not None:
        first, other = course.rewound
        windings = windings.followed_by(other, first, n)
    windings = windings.warmed(operation.warming).saturated(
        1.0 - simulated.saturation * (operation.relative_voltage / operation.frequency_ratio - 1.0)
    )
    shorted = None
    if course.level.any():
        shorted = Shorted(course.level * (1.0 + course.path_ratio), course.path_ratio, course.winding)
    found = running(
        windings,
        voltage,
        nameplate.rated_angular_frequency * operation.frequency_ratio,
        nameplate.rated_torque_Nm * operation.load,
        pole_pairs=nameplate.pole_pairs,
        delta=simulated.delta,
        shorted=shorted,
        line_resistance_ohm=course.line_resistance_ohm if course.line_resistance_ohm.any() else None,
    )
    current = found.line_current_A
    if course.beside is not None:
        current = current + np.einsum("nij,nj->ni", course.beside, voltage)
    if course.second is not None:
        current = current + _of_second(course.second, voltage, operation)
    terminals = TERMINALS[simulated.sequence]
    zero = (rated_V * operation.relative_voltage * operation.displacement)[:, np.newaxis]
    return voltage[:, terminals] + zero, current[:, terminals]


def _of_second(second: tuple[int, SimulatedMotor], voltage: Complex, operation: Operation) -> Complex:
    """Line currents of another motor on the same terminals, with the load and the warmth of the first."""
    first, other = second
    plate = other.motor.nameplate
    found = running(
        other.windings.warmed(operation.warming),
        voltage,
        plate.rated_angular_frequency * operation.frequency_ratio,
        plate.rated_torque_Nm * operation.load,
        pole_pairs=plate.pole_pairs,
        delta=other.delta,
    )
    runs = np.arange(len(operation)) >= first
    return found.line_current_A * runs[:, np.newaxis]


def measure(
    random: np.random.Generator,
    simulated: SimulatedMotor,
    operation: Operation,
    course: Course,
    noise: float,
) -> Measured:
    """Send the phasors through the channels and turn them into the windings' frame."""
    voltage, current = true_phasors(simulated, operation, course)
    nameplate = simulated.motor.nameplate
    rated_V = np.sqrt(2 / 3) * nameplate.rated_voltage_V
    if simulated.voltage_channels is not VoltageChannels.PHASE:
        voltage = voltage - np.roll(voltage, -1, axis=1)
        rated_V *= np.sqrt(3)
    rated_A = simulated.winding_voltage_V / negative_impedance_ohm(simulated)
    rated_A *= np.sqrt(3) if simulated.delta else 1.0
    seen_voltage = voltage * simulated.channels.voltage * course.voltage_ratio
    seen_voltage = seen_voltage + noise * rated_V * _white(random, voltage.shape)
    seen_current = current * simulated.channels.current * course.current_ratio
    seen_current = seen_current + noise * rated_A * _white(random, current.shape)

    axes = CLARKE
    zero_voltage = seen_voltage.mean(axis=1)
    if simulated.voltage_channels is not VoltageChannels.PHASE:
        axes = CLARKE_OF_LINES
        if simulated.voltage_channels is VoltageChannels.TWO_LINES:
            seen_voltage[:, 2] = -seen_voltage[:, 0] - seen_voltage[:, 1]
    V1, V2 = _sequences(axes, seen_voltage, simulated, voltage=True)
    I1, I2 = _sequences(CLARKE, seen_current, simulated, voltage=False)
    variance = 2 / 3 * noise**2
    return Measured(
        time_ns=operation.time_ns,
        recorder=course.recorder,
        frequency_hz=nameplate.rated_frequency_Hz * operation.frequency_ratio,
        positive_voltage_V=V1,
        negative_voltage_V=V2,
        zero_voltage_V=zero_voltage,
        positive_current_A=I1,
        negative_current_A=I2,
        zero_current_A=seen_current.mean(axis=1),
        scatter=variance * random.uniform(*SCATTER_SPAN) * random.chisquare(20, len(operation)) / 20,
        load=operation.load,
        sequence=simulated.sequence,
        voltage_channels=simulated.voltage_channels,
    )


def with_outliers(random: np.random.Generator, measured: Measured, share: float) -> Measured:
    """The same with a share of the records ten times as noisy, though they do not say so."""
    hit = random.uniform(size=len(measured)) < share
    noise = OUTLIER * np.sqrt(measured.scatter.mean()) * hit
    volts = noise * np.abs(measured.positive_voltage_V)
    return replace(
        measured, negative_voltage_V=measured.negative_voltage_V + volts * _white(random, volts.shape)
    )


def negative_impedance_ohm(simulated: SimulatedMotor) -> float:
    """|Z2| of the machine at rated frequency."""
    windings, w = simulated.windings, simulated.motor.nameplate.rated_angular_frequency
    resistance = windings.stator_resistance_ohm[0] + windings.rotor_resistance_ohm[0] / 2
    leakage = windings.stator_leakage_H[0] + windings.rotor_leakage_H[0]
    return float(np.hypot(resistance, w * leakage))


def _sequences(
    axes: Array, terminals: Complex, simulated: SimulatedMotor, *, voltage: bool
) -> tuple[Complex, Complex]:
    """Positive and negative sequence of the windings in a supply of positive sequence."""
    alpha, beta = axes @ terminals.T
    if simulated.sequence is PhaseSequence.ACB:
        beta = -beta
    first, second = (alpha + 1j * beta) / np.sqrt(6), (alpha - 1j * beta) / np.sqrt(6)
    if simulated.delta:
        turn = np.exp(1j * np.pi / 6)
        stretch = np.sqrt(3) if voltage else 1 / np.sqrt(3)
        return first * turn * stretch, second / turn * stretch
    return first, second


def _white(random: np.random.Generator, size: tuple[int, ...]) -> Complex:
    return np.asarray((random.standard_normal(size) + 1j * random.standard_normal(size)) / np.sqrt(2))
