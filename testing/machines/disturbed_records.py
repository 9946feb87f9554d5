"""Records from physics of their own: the simulator's windings in phase variables, integrated in time.

The estimator's models share nothing with them: no Clarke axes, no shunt, another integration. The thesis's
additional shorted winding is put together here from the same coils.
"""

from dataclasses import dataclass, replace
from math import inf, pi

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from core.machines.parameters import MachineParameters, Motor
from core.recordings import Channel, Quantity, Recording
from ied_sim.motor.fault import FaultCourse
from ied_sim.motor.load import Load
from ied_sim.motor.plant import STEP_RATE_HZ, MotorPlant, rated_current
from ied_sim.motor.rotor import PHASE_AXES
from ied_sim.motor.sensors import Sensors
from ied_sim.motor.supply import Harmonic, Supply
from ied_sim.motor.windings import WindingCircuit, winding_circuit
from testing.machines.steady_faults import Condition, FaultModel

Array = NDArray[np.float64]

CHANNELS = tuple(
    Channel(f"{letter}{phase.upper()}", quantity, phase, unit)
    for letter, quantity, unit in (("I", Quantity.CURRENT, "A"), ("V", Quantity.PHASE_VOLTAGE, "V"))
    for phase in ("a", "b", "c")
)
FULL_SCALE_CURRENT = 10.0
"""Of the rated one, peak over rms; what a relay's converters reach to."""
FULL_SCALE_VOLTAGE = 2.0
CUBIC_MARGIN = 4
"""Samples before and behind a window, for the interpolation at its ends."""


@dataclass(frozen=True, slots=True)
class MotorWithAdditionalWinding(MotorPlant):
    """The thesis's stator (6.10-6.15): three whole phases and beside them a winding of mu times the turns."""

    level: float = 0.0
    phase: int = 0

    def circuit(self, time_s: float, closed_s: float = -inf) -> WindingCircuit:
        del time_s, closed_s
        return additional_winding_circuit(self.motor, self.level, self.phase)


def additional_winding_circuit(motor: Motor, level: float, winding: int) -> WindingCircuit:
    """The healthy star's loops (two of the stator, two of the cage) and, third, the additional winding's.

    It has mu of the turns, mu of the resistance and mu^2 of the leakage of a phase, on the phase's axis.
    """
    machine = motor.parameters
    healthy = winding_circuit(motor)
    old = np.array([0, 1, 3, 4])
    leakage, constant, cosine, sine, resistance = (np.zeros((5, 5)) for _ in range(5))
    for grown, matrix in (
        (leakage, healthy.leakage),
        (constant, healthy.constant),
        (cosine, healthy.cosine),
        (sine, healthy.sine),
        (resistance, healthy.resistance),
    ):
        grown[np.ix_(old, old)] = matrix
    # Loop currents 1 and 2 of a star, and of the cage, are those of phases a and b; c carries both back.
    loop = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, -1.0]])
    angle = PHASE_AXES - PHASE_AXES[winding]
    full = level * machine.stator_self_inductance_H
    constant[2, :2] = constant[:2, 2] = full * np.cos(angle) @ loop
    cosine[2, 3:] = cosine[3:, 2] = full * np.cos(angle) @ loop
    # cos(angle + theta) from the winding to the turning axes.
    sine[2, 3:] = sine[3:, 2] = -full * np.sin(angle) @ loop
    leakage[2, 2] = level**2 * machine.stator_leakage_H
    constant[2, 2] = level**2 * machine.stator_self_inductance_H
    resistance[2, 2] = level * machine.stator_resistance_ohm
    drive = np.zeros((5, 3))
    drive[:2] = healthy.drive[:2]
    rotor_current = np.zeros((2, len(leakage)))
    rotor_current[:, old] = healthy.rotor_current
    return WindingCircuit(
        leakage,
        np.zeros_like(leakage),
        constant,
        cosine,
        sine,
        resistance,
        drive,
        np.zeros((2, len(leakage))),
        rotor_current,
    )


def plant_of(motor: Motor, model: FaultModel, condition: Condition, supply: Supply, load: Load) -> MotorPlant:
    """A motor in a condition, with sensors that `measure` does not use."""
    sensors = Sensors(1.0, 1.0)
    if condition.level == 0.0:
        return MotorPlant(motor, supply, load, sensors)
    if model is FaultModel.ADDITIONAL:
        return MotorWithAdditionalWinding(
            motor, supply, load, sensors, level=condition.level, phase=condition.winding
        )
    path = condition.path_resistance_ohm(motor)
    course = FaultCourse(condition.winding, ((0.0, condition.level),), path)
    return MotorPlant(motor, supply, load, sensors, fault=course)


def steady_samples(
    motor: Motor, model: FaultModel, condition: Condition, samples: int, sample_rate_hz: float
) -> Array:
    """True currents and voltages in steady running at rated frequency, shape (6, samples)."""
    nameplate = motor.nameplate
    supply = Supply(
        nameplate.rated_voltage_V * abs(condition.relative_voltage),
        nameplate.rated_frequency_Hz,
        unbalance=abs(condition.unbalance),
        unbalance_angle_rad=float(np.angle(condition.unbalance)),
        sequence="acb" if condition.reverse else "abc",
    )
    plant = plant_of(motor, model, condition, supply, Load(condition.load_level))
    true = plant.operation(0.0, samples / sample_rate_hz, sample_rate_hz, settling_s=2.0)
    return np.vstack([true.currents_A, true.voltages_V])


def rms_noise(samples: Array, current: float, voltage: float) -> Array:
    """Standard deviations of white noise, shape (6,), from shares of the currents' and the voltages' rms."""
    rms = [float(np.sqrt(np.mean(part**2))) for part in (samples[:3], samples[3:])]
    return np.repeat([rms[0] * current, rms[1] * voltage], 3)


def record_of(samples: Array, sample_rate_hz: float) -> Recording:
    """A recording of IA IB IC [A], VA VB VC [V], shape (6, n)."""
    return Recording(samples, sample_rate_hz, 0, CHANNELS)


@dataclass(frozen=True, slots=True)
class Disturbances:
    """Everything that may make a healthy motor look otherwise; the defaults are none of it.

    gain_errors: relative, of the six channels.  delays_s: of the six channels.
    harmonics: orders, shares of the fundamental, angles.  swing: of the load torque, over rated torque.
    parameter_factors: true over nameplate parameters, of R_s, R_r, L_ls, L_lr, L_s.
    noise: white, of rated values, beside 16-bit converters.
    """

    gain_errors: tuple[float, ...] = (0.0,) * 6
    delays_s: tuple[float, ...] = (0.0,) * 6
    harmonics: tuple[tuple[int, float, float], ...] = ()
    frequency_hz: float = 50.0
    swing: float = 0.0
    swing_frequency_hz: float = 1.0
    parameter_factors: tuple[float, ...] = (1.0,) * 5
    noise: float = 0.0


def disturbed_record(
    motor: Motor,
    condition: Condition,
    disturbances: Disturbances,
    *,
    start_s: float,
    cycles: float,
    sample_rate_hz: float,
    seed: int,
    step_rate_hz: float = STEP_RATE_HZ,
) -> Recording:
    """What a relay records of a motor (split winding where faulty), `cycles` of its rated frequency long.

    Channels that sample late see the waveforms as they were earlier: voltages are evaluated there, currents
    interpolated from the steps of the integration. Harmonics above a rate's reach are to be left out by the
    caller, as the relay's filter would.
    """
    true_motor = replace(motor, parameters=_true_parameters(motor.parameters, disturbances))
    supply = Supply(
        motor.nameplate.rated_voltage_V,
        disturbances.frequency_hz,
        unbalance=abs(condition.unbalance),
        unbalance_angle_rad=float(np.angle(condition.unbalance)),
        harmonics=tuple(Harmonic(*one) for one in disturbances.harmonics),
        sequence="acb" if condition.reverse else "abc",
    )
    load = Load(condition.load_level, disturbances.swing, 1.0 / disturbances.swing_frequency_hz)
    plant = plant_of(true_motor, FaultModel.SPLIT, condition, supply, load)

    samples = round(cycles / motor.nameplate.rated_frequency_Hz * sample_rate_hz)
    times = start_s + np.arange(samples) / sample_rate_hz
    margin = max(disturbances.delays_s) + CUBIC_MARGIN / step_rate_hz
    first = start_s - margin
    true = plant.operation(first, times[-1] - first + 2 * margin, step_rate_hz, step_rate_hz=step_rate_hz)
    grid = first + np.arange(true.currents_A.shape[1]) / step_rate_hz
    seen = np.empty((6, samples))
    for channel, delay in enumerate(disturbances.delays_s):
        if channel < 3:
            seen[channel] = CubicSpline(grid, true.currents_A[channel])(times - delay)
        else:
            seen[channel] = supply.phase_voltages(times - delay)[channel - 3]
    sensors = Sensors(
        full_scale_A=FULL_SCALE_CURRENT * rated_current(motor),
        full_scale_V=FULL_SCALE_VOLTAGE * motor.nameplate.rated_voltage_V,
        gain_errors=disturbances.gain_errors,
        noise=disturbances.noise,
    )
    measured = sensors.measure(seen, plant.rated_values, np.random.default_rng(seed))
    return record_of(measured, sample_rate_hz)


def _true_parameters(nameplate: MachineParameters, disturbances: Disturbances) -> MachineParameters:
    R_s, R_r, L_ls, L_lr, L_s = disturbances.parameter_factors
    return MachineParameters(
        nameplate.stator_resistance_ohm * R_s,
        nameplate.rotor_resistance_ohm * R_r,
        nameplate.stator_leakage_H * L_ls,
        nameplate.rotor_leakage_H * L_lr,
        nameplate.stator_self_inductance_H * L_s,
        nameplate.inertia_kgm2,
    )


def random_harmonics(
    random: np.random.Generator, distortion: float, sample_rate_hz: float
) -> tuple[tuple[int, float, float], ...]:
    """Orders 5, 7, 11, 13 below 0.9 of half the sampling rate, of a total harmonic distortion, at random
    shares (falling with the order) and angles."""
    orders = [order for order in (5, 7, 11, 13) if order * 51.0 < 0.45 * sample_rate_hz]
    weights = random.uniform(size=len(orders)) / np.array(orders)
    shares = distortion * weights / np.linalg.norm(weights) if orders else weights
    return tuple(
        (order, float(share), float(random.uniform(0.0, 2.0 * pi)))
        for order, share in zip(orders, shares, strict=True)
    )
