"""Air-gap torque, slip and load torque of a start, from the samples and the motor's parameters.

    psi_s = integral of (v - R_s i)          from rest, where there is no flux
    T     = p psi_s x i
    w_slip = R_r T / (p |psi_r|^2)           psi_r = L_r/L_m (psi_s - sigma L_s i)
    T_load = (integral of T - J w_m) / t     mean over the run-up of length t

The integral of the torque is what has given the shaft its speed and fed the load. So the load torque needs no
model of the rotor. All curves are means over one cycle of the supply: in them the torque of what is direct
current at first cancels. Slip needs steady flux; its first cycles are left out.
"""

from dataclasses import dataclass
from math import ceil, hypot, pi, sqrt
from typing import Final

import numpy as np
from scipy.ndimage import uniform_filter1d

from core.commissioning.start import Start
from core.machines.base import Array
from core.machines.parameters import MachineParameters, Motor, ParametersSource

MOST_POINTS: Final = 400
"""Points of a curve: a longer start has one for several cycles."""
UNSETTLED_CYCLES: Final = 3
"""Cycles after the switching in which the rotor's flux is not that of its slip."""
INERTIA_TOLERANCE: Final = {
    ParametersSource.GIVEN: 0.2,
    ParametersSource.DATA_SHEET: 0.2,
    ParametersSource.COMMISSIONED: 0.05,
    ParametersSource.TYPICAL: 9.0,
}
"""Share by which the inertia of motor and load may be off, by where the parameters come from."""


@dataclass(frozen=True, slots=True)
class StartTorque:
    """Torque and slip of a start.

    Parameters
    ----------
    first_s, step_s : float
        Time of the first point after the switching, and between two points [s].
    torque_Nm : tuple of float
        Torque of the air gap, means over one cycle or several [N m].
    speed : tuple of float or None
        Speed over the synchronous one at the same points; None in the first cycles.
    rated_torque_Nm : float
        Torque that load level 1 stands for [N m].
    impulse_Nms : float
        Integral of the torque over the run-up, or over as much of it as the record has [N m s].
    mean_torque_Nm : float
        Its mean over that time [N m].
    torque_at_rated_voltage_Nm : float
        That mean at rated voltage: torque goes with the square of the voltage [N m].
    momentum_Nms : float or None
        Inertia times the speed at the end of the run-up [N m s]; None where the record ends before.
    momentum_tolerance : float
        Share by which it may be off.
    load_torque_Nm : float or None
        Mean torque of the load during the run-up [N m].
    load_torque_Nm_ci95 : tuple of float or None
        Its 95 % interval, by the errors of sensors, resistance and inertia [N m].
    running_torque_Nm : float or None
        Torque once the motor runs [N m].
    """

    first_s: float
    step_s: float
    torque_Nm: tuple[float, ...]
    speed: tuple[float | None, ...]
    rated_torque_Nm: float
    impulse_Nms: float
    mean_torque_Nm: float
    torque_at_rated_voltage_Nm: float
    momentum_Nms: float | None
    momentum_tolerance: float
    load_torque_Nm: float | None
    load_torque_Nm_ci95: tuple[float, float] | None
    running_torque_Nm: float | None


@dataclass(frozen=True, slots=True)
class AirGap:
    """What the air gap of a starting motor does, sample by sample from the switching on.

    Parameters
    ----------
    sample_rate_hz : float
        Sampling rate [Hz].
    cycle : int
        Samples in one cycle of the supply.
    frequency_hz : float
        Supply frequency [Hz].
    voltage_ab, current_ab : ndarray, shape (2, n)
        Winding quantities on Clarke axes [V, A].
    torque_Nm : ndarray, shape (n,)
        Torque [N m].
    slip : ndarray, shape (n,)
        Slip by the torque and the rotor's flux, over one cycle about each sample.
    """

    sample_rate_hz: float
    cycle: int
    frequency_hz: float
    voltage_ab: Array
    current_ab: Array
    torque_Nm: Array
    slip: Array


def air_gap(start: Start, machine: MachineParameters) -> AirGap:
    """Integrate flux and torque of a start.

    Parameters
    ----------
    start : Start
        Winding quantities of the start.
    machine : MachineParameters
        Parameters of the motor.

    Returns
    -------
    AirGap
        Torque and slip.
    """
    rate, p = start.sample_rate_hz, start.nameplate.pole_pairs
    first = round(start.switched_on_s * rate)
    v, i = start.voltage_ab[:, first:], start.current_ab[:, first:]
    cycle = round(rate / start.frequency_hz)
    emf = v - machine.stator_resistance_ohm * i
    psi_s = np.zeros_like(emf)
    np.cumsum((emf[:, 1:] + emf[:, :-1]) / (2.0 * rate), axis=1, out=psi_s[:, 1:])
    torque = p * (psi_s[0] * i[1] - psi_s[1] * i[0])

    L_m = machine.magnetising_inductance_H
    L_s, L_r = L_m + machine.stator_leakage_H, L_m + machine.rotor_leakage_H
    psi_r = L_r / L_m * _alternating(psi_s - (L_s - L_m**2 / L_r) * i, cycle)
    psi_r_squared = uniform_filter1d(np.sum(psi_r**2, axis=0), cycle, mode="nearest")
    w_slip = (
        machine.rotor_resistance_ohm / p * uniform_filter1d(torque, cycle, mode="nearest") / psi_r_squared
    )
    slip = w_slip / (2.0 * pi * start.frequency_hz)
    return AirGap(rate, cycle, start.frequency_hz, v, i, torque, slip)


def start_torque(
    start: Start, motor: Motor, acceleration_s: float | None, *, lasts_s: float | None = None
) -> StartTorque:
    """Measure torque, speed and load of a start.

    Parameters
    ----------
    start : Start
        Winding quantities of the start.
    motor : Motor
        Its motor, whose parameters are used.
    acceleration_s : float or None
        Time from the switching until the motor is up to speed; None where the record does not show it [s].
    lasts_s : float or None, optional
        Part of the record that is looked at, after the switching [s]; None for all.

    Returns
    -------
    StartTorque
        Torque, speed and load.
    """
    gap = air_gap(start, motor.parameters)
    n = gap.torque_Nm.size if lasts_s is None else min(gap.torque_Nm.size, round(lasts_s * gap.sample_rate_hz))
    end = n if acceleration_s is None else min(n, round(acceleration_s * gap.sample_rate_hz))
    lasted_s = end / gap.sample_rate_hz
    impulse = float(gap.torque_Nm[:end].sum()) / gap.sample_rate_hz
    volts = sqrt(float(np.mean(np.sum(gap.voltage_ab[:, :end] ** 2, axis=0)))) / start.line_per_winding_current
    running = None if acceleration_s is None else _running_torque(gap, end)
    momentum, load, ci95 = None, None, None
    tolerance = INERTIA_TOLERANCE[motor.parameters_source]
    if acceleration_s is not None:
        w_m = 2.0 * pi * gap.frequency_hz / start.nameplate.pole_pairs
        momentum = motor.parameters.inertia_kgm2 * w_m * float(np.clip(1.0 - gap.slip[end - 1], 0.0, 1.0))
        load = (impulse - momentum) / lasted_s
        error = hypot(_torque_error(gap, motor, end), tolerance * momentum / lasted_s)
        ci95 = (load - error, min(load + error, impulse / lasted_s))
    points = gap.cycle * max(1, ceil(n / gap.cycle / MOST_POINTS))
    return StartTorque(
        first_s=points / 2.0 / gap.sample_rate_hz,
        step_s=points / gap.sample_rate_hz,
        torque_Nm=tuple(_rounded(one) for one in _means(gap.torque_Nm[:n], points)),
        speed=_speeds(gap, n, points),
        rated_torque_Nm=start.nameplate.rated_torque_Nm,
        impulse_Nms=impulse,
        mean_torque_Nm=impulse / lasted_s,
        torque_at_rated_voltage_Nm=impulse / lasted_s * (start.nameplate.rated_voltage_V / volts) ** 2,
        momentum_Nms=momentum,
        momentum_tolerance=tolerance,
        load_torque_Nm=load,
        load_torque_Nm_ci95=ci95,
        running_torque_Nm=running,
    )


def _alternating(x: Array, cycle: int) -> Array:
    """Return a quantity without its mean over the cycle about each sample."""
    return np.asarray(x - uniform_filter1d(x, cycle, axis=1, mode="nearest"))


def _means(x: Array, samples: int) -> list[float]:
    whole: list[float] = x[: x.size // samples * samples].reshape(-1, samples).mean(axis=1).tolist()
    return whole


def _speeds(gap: AirGap, n: int, points: int) -> tuple[float | None, ...]:
    """Return the speed over the synchronous one of each point; None where the flux has not settled."""
    speeds = _means(1.0 - gap.slip[:n], points)
    unsettled = min(len(speeds), ceil(UNSETTLED_CYCLES * gap.cycle / points))
    return (*(None,) * unsettled, *map(_rounded, speeds[unsettled:]))


def _running_torque(gap: AirGap, end: int) -> float | None:
    """Return the torque of the last cycles of the record, where some come after the run-up."""
    after = gap.torque_Nm[end + gap.cycle :]
    whole = min(5, after.size // gap.cycle) * gap.cycle
    return float(after[-whole:].mean()) if whole else None


def _torque_error(gap: AirGap, motor: Motor, end: int) -> float:
    """Return by how much the mean torque may be off: gains of both sensors, and the stator's resistance."""
    mean = abs(float(gap.torque_Nm[:end].mean()))
    gains = hypot(motor.sensors.voltage_gain, motor.sensors.current_gain)
    w_m = 2.0 * pi * gap.frequency_hz / motor.nameplate.pole_pairs
    copper_W = motor.parameters.stator_resistance_ohm * float(np.mean(np.sum(gap.current_ab[:, :end] ** 2, 0)))
    return hypot(gains * mean, min(motor.tolerances.stator_resistance_ohm, 1.0) * copper_W / w_m)


def _rounded(value: float) -> float:
    return float(f"{value:.5g}")
