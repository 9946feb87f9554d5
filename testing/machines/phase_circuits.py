"""An independent model for the tests: three-phase windings in phase variables, solved by phasors.

No Clarke axes, no flux states, no time stepping: the stator's three phases and the rotor's three equivalent
phases are coupled impedances at +w_s, the faulted phase is split into its two parts, and the slip follows
from the air-gap power of both sequences. Zero sequence and star point are solved for, not assumed.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from core.machines.parameters import Connection, Motor
from core.recordings import Channel, Quantity, Recording

Complex = NDArray[np.complex128]
A = np.exp(2j * np.pi / 3)
FORTESCUE = np.array([[1, 1, 1], [1, A**2, A], [1, A, A**2]])
NAMES = ("IA", "IB", "IC", "VA", "VB", "VC")


@dataclass(frozen=True)
class Fault:
    level: float
    winding: int
    path_resistance_ohm: float = 0.0


@dataclass(frozen=True)
class Operation:
    line_current: Complex
    phase_voltage: Complex
    slip: float


def running(
    motor: Motor,
    load_level: float,
    *,
    fault: Fault | None = None,
    unbalance: complex = 0.0,
    reverse: bool = False,
    joint: tuple[int, float] | None = None,
) -> Operation:
    """Line currents and phase voltages (rms phasors of a, b, c) in steady running at rated voltage.

    joint: a winding and the resistance of a bad connection in series with it [ohm].
    """
    volts = motor.nameplate.rated_voltage_V / np.sqrt(3)
    sequence = np.array([0, unbalance, 1]) if reverse else np.array([0, 1, unbalance])
    voltage = FORTESCUE @ sequence * volts
    direction = -1 if reverse else 1
    slip = brentq(
        lambda s: _torque_surplus(motor, voltage, s, load_level, fault, direction, joint), -0.01, 0.12
    )
    return Operation(_currents(motor, voltage, slip, fault, direction, joint)[0], voltage, slip)


def recording(
    operation: Operation,
    *,
    frequency_hz: float = 50.0,
    sample_rate_hz: float = 10_000.0,
    seconds: float = 0.6,
    current_delay_s: float = 0.0,
    noise: float = 0.0,
    current_gains: tuple[float, float, float] = (1.0, 1.0, 1.0),
    seed: int = 0,
) -> Recording:
    """What a relay would record; `noise` is the standard deviation over each signal's rms."""
    rng = np.random.default_rng(seed)
    t = np.arange(round(seconds * sample_rate_hz)) / sample_rate_hz
    phasors = np.concatenate([operation.line_current * np.array(current_gains), operation.phase_voltage])
    delay = np.array([current_delay_s] * 3 + [0.0] * 3)[:, np.newaxis]
    w = 2 * np.pi * frequency_hz
    samples = np.sqrt(2) * np.real(phasors[:, np.newaxis] * np.exp(1j * w * (t - delay)))
    samples += noise * np.abs(phasors)[:, np.newaxis] * rng.standard_normal(samples.shape)
    quantities = (Quantity.CURRENT, Quantity.PHASE_VOLTAGE)
    channels = tuple(
        Channel(name, quantities[k // 3], "abc"[k % 3], "AV"[k // 3]) for k, name in enumerate(NAMES)
    )
    return Recording(samples, sample_rate_hz, 0, channels)


def _torque_surplus(
    motor: Motor,
    voltage: Complex,
    slip: float,
    load_level: float,
    fault: Fault | None,
    direction: int,
    joint: tuple[int, float] | None,
) -> float:
    _, rotor = _currents(motor, voltage, slip, fault, direction, joint)
    R_r = motor.parameters.rotor_resistance_ohm
    forward, backward = (1, 2) if direction > 0 else (2, 1)
    power = np.abs(np.linalg.solve(FORTESCUE, rotor)) ** 2 * 3 * R_r
    w_s = motor.nameplate.rated_angular_frequency / motor.nameplate.pole_pairs
    torque = (power[forward] / slip if slip else 0.0) - power[backward] / (2 - slip)
    return float(torque / w_s - load_level * motor.nameplate.rated_torque_Nm)


def _currents(
    motor: Motor,
    voltage: Complex,
    slip: float,
    fault: Fault | None,
    direction: int,
    joint: tuple[int, float] | None,
) -> tuple[Complex, Complex]:
    """Line currents and rotor currents (referred, seen from the stator), by one linear system.

    Unknowns: winding currents (3), rotor currents (3), current of the fault path, the star point's potential.
    """
    machine, nameplate = motor.parameters, motor.nameplate
    jw = 1j * nameplate.rated_angular_frequency
    L_s = machine.stator_self_inductance_H
    mutual = L_s * np.array([[1, -0.5, -0.5], [-0.5, 1, -0.5], [-0.5, -0.5, 1]])
    # Seen from the stator, the rotor's resistance is R_r / s for one sequence, R_r / (2 - s) for the other.
    slips = np.array([1.0, slip, 2 - slip]) if direction > 0 else np.array([1.0, 2 - slip, slip])
    safe = np.where(np.abs(slips) < 1e-12, 1e-12, slips)
    rotor_resistance = FORTESCUE @ np.diag(machine.rotor_resistance_ohm / safe) @ np.linalg.inv(FORTESCUE)

    M = np.zeros((8, 8), dtype=np.complex128)
    rhs = np.zeros(8, dtype=np.complex128)
    M[:3, :3] = (machine.stator_resistance_ohm + jw * machine.stator_leakage_H) * np.eye(3) + jw * mutual
    if joint is not None:
        M[joint[0], joint[0]] += joint[1]
    M[:3, 3:6] = jw * mutual
    M[3:6, :3] = jw * mutual
    M[3:6, 3:6] = rotor_resistance + jw * machine.rotor_leakage_H * np.eye(3) + jw * mutual
    if fault is None:
        M[6, 6] = 1.0
    else:
        x, mu = fault.winding, fault.level
        own = machine.stator_resistance_ohm + jw * machine.stator_leakage_H
        M[:3, 6] = -mu * jw * mutual[:, x]
        M[x, 6] -= mu * own
        M[3:6, 6] = -mu * jw * mutual[:, x]
        # Loop of the shorted part and its path: mu (own (i_x - i_f) + jw psi_m) = r_f i_f
        M[6, :3] = mu * jw * mutual[x]
        M[6, x] += mu * own
        M[6, 3:6] = mu * jw * mutual[x]
        M[6, 6] = -mu * own - mu**2 * jw * L_s - fault.path_resistance_ohm
    if nameplate.connection is Connection.STAR:
        rhs[:3] = voltage
        M[:3, 7] = 1.0
        M[7, :3] = 1.0
        turn = np.eye(3)
    else:
        rhs[:3] = voltage - np.roll(voltage, -1)
        M[7, 7] = 1.0
        turn = np.eye(3) - np.roll(np.eye(3), 1, axis=0)
    solution: Complex = np.asarray(np.linalg.solve(M, rhs), dtype=np.complex128)
    return np.asarray(turn @ solution[:3], dtype=np.complex128), solution[3:6]
