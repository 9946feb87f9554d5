"""Torque, speed and load of a start, from the samples and the motor's parameters.

    T_load = (integral of T - J w_m) / t     mean over the run-up of length t, T the torque of the air gap

The integral of the torque is what has given the shaft its speed and fed the load. So the load torque needs no
model of the rotor. All curves are means over one cycle of the supply: in them the torque of what is direct
current at first cancels.
"""

from math import ceil, hypot, pi, sqrt
from typing import Final

import numpy as np

from core.machines.air_gap import UNSETTLED_CYCLES, AirGap
from core.machines.base import Array
from core.machines.parameters import Connection, Motor, ParametersSource
from core.starts.examined import StartTorque

MOST_POINTS: Final = 400
"""Points of a curve: a longer start has one for several cycles."""
INERTIA_TOLERANCE: Final = {
    ParametersSource.GIVEN: 0.2,
    ParametersSource.DATA_SHEET: 0.2,
    ParametersSource.COMMISSIONED: 0.05,
    ParametersSource.TYPICAL: 9.0,
}
"""Share by which the inertia of motor and load may be off, by where the parameters come from."""


def start_torque(gap: AirGap, motor: Motor, acceleration_s: float | None) -> StartTorque:
    """Measure torque, speed and load of a start.

    Parameters
    ----------
    gap : AirGap
        Torque and slip of the start.
    motor : Motor
        Its motor.
    acceleration_s : float or None
        Time from the switching until the motor is up to speed; None where the record does not show it [s].

    Returns
    -------
    StartTorque
        Torque, speed and load.
    """
    plate, n = motor.nameplate, gap.torque_Nm.size
    end = n if acceleration_s is None else min(n, round(acceleration_s * gap.sample_rate_hz))
    lasted_s = end / gap.sample_rate_hz
    impulse = float(gap.torque_Nm[:end].sum()) / gap.sample_rate_hz
    volts = sqrt(float(np.mean(np.sum(gap.voltage_ab[:, :end] ** 2, axis=0))))
    if plate.connection is Connection.DELTA:
        volts /= sqrt(3.0)
    running = None if acceleration_s is None else _running_torque(gap, end)
    momentum, load, ci95 = None, None, None
    tolerance = INERTIA_TOLERANCE[motor.parameters_source]
    if acceleration_s is not None:
        w_m = 2.0 * pi * gap.frequency_hz / plate.pole_pairs
        momentum = motor.parameters.inertia_kgm2 * w_m * float(np.clip(1.0 - gap.slip[end - 1], 0.0, 1.0))
        load = (impulse - momentum) / lasted_s
        error = hypot(_torque_error(gap, motor, end), tolerance * momentum / lasted_s)
        ci95 = (load - error, min(load + error, impulse / lasted_s))
    points = gap.cycle * max(1, ceil(n / gap.cycle / MOST_POINTS))
    return StartTorque(
        first_s=points / 2.0 / gap.sample_rate_hz,
        step_s=points / gap.sample_rate_hz,
        torque_Nm=tuple(_rounded(one) for one in _means(gap.torque_Nm, points)),
        speed=_speeds(gap, points),
        rated_torque_Nm=plate.rated_torque_Nm,
        impulse_Nms=impulse,
        mean_torque_Nm=impulse / lasted_s,
        torque_at_rated_voltage_Nm=impulse / lasted_s * (plate.rated_voltage_V / volts) ** 2,
        momentum_Nms=momentum,
        momentum_tolerance=tolerance,
        load_torque_Nm=load,
        load_torque_Nm_ci95=ci95,
        running_torque_Nm=running,
    )


def _means(x: Array, samples: int) -> list[float]:
    whole: list[float] = x[: x.size // samples * samples].reshape(-1, samples).mean(axis=1).tolist()
    return whole


def _speeds(gap: AirGap, points: int) -> tuple[float | None, ...]:
    """Return the speed over the synchronous one of each point; None where the flux has not settled."""
    speeds = _means(1.0 - gap.slip, points)
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
    copper_W = motor.parameters.stator_resistance_ohm * float(
        np.mean(np.sum(gap.current_ab[:, :end] ** 2, 0))
    )
    return hypot(gains * mean, min(motor.tolerances.stator_resistance_ohm, 1.0) * copper_W / w_m)


def _rounded(value: float) -> float:
    return float(f"{value:.5g}")
