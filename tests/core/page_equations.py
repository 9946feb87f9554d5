"""The equations of the two fault models as they stand on the page, integrated by scipy: slow, independent.

Currents are found from fluxes by solving the flux equations written as a function of the currents, column by
column; nothing of the models' own matrices is used.
"""

from collections.abc import Callable
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from core.machines.parameters import Motor

Array = NDArray[np.float64]
K = np.sqrt(2.0 / 3.0)
J = np.array([[0.0, -1.0], [1.0, 0.0]])


def axis(winding: int) -> Array:
    angle = 2.0 * np.pi / 3.0 * winding
    return np.array([np.cos(angle), np.sin(angle)])


def shorted_winding_fluxes(motor: Motor, mu: float, winding: int, z: Array) -> Array:
    """psi_s, psi_r, psi_f of thesis 6.13-6.15 from i_s, i_r, i_f."""
    p, n = motor.parameters, axis(winding)
    i_s, i_r, i_f = z[0:2], z[2:4], z[4]
    psi_m = p.magnetising_inductance_H * (i_s + i_r + K * mu * i_f * n)
    psi_f = mu * (K * n @ psi_m) + mu**2 * p.stator_leakage_H * i_f
    return np.concatenate([p.stator_leakage_H * i_s + psi_m, p.rotor_leakage_H * i_r + psi_m, [psi_f]])


def shorted_winding_drops(motor: Motor, mu: float, winding: int, v: Array, z: Array) -> Array:
    p = motor.parameters
    return np.concatenate(
        [
            v - p.stator_resistance_ohm * z[0:2],
            -p.rotor_resistance_ohm * z[2:4],
            [-mu * p.stator_resistance_ohm * z[4]],
        ]
    )


def split_winding_fluxes(motor: Motor, mu: float, winding: int, z: Array) -> Array:
    """psi_s, psi_r, psi_x2 of Tallam's model from i_s, i_r, i_f."""
    p, n = motor.parameters, axis(winding)
    i_s, i_r, i_f = z[0:2], z[2:4], z[4]
    sound = i_s - K * n * mu * i_f
    psi_m = p.magnetising_inductance_H * (sound + i_r)
    psi_x2 = mu * (p.stator_leakage_H * (K * n @ i_s - i_f) + K * n @ psi_m)
    return np.concatenate([p.stator_leakage_H * sound + psi_m, p.rotor_leakage_H * i_r + psi_m, [psi_x2]])


def split_winding_drops(motor: Motor, mu: float, winding: int, v: Array, z: Array) -> Array:
    p, n = motor.parameters, axis(winding)
    i_s, i_r, i_f = z[0:2], z[2:4], z[4]
    return np.concatenate(
        [
            v - p.stator_resistance_ohm * (i_s - K * n * mu * i_f),
            -p.rotor_resistance_ohm * i_r,
            [-mu * p.stator_resistance_ohm * (K * n @ i_s - i_f)],
        ]
    )


PAGES = {
    "shorted-winding": (shorted_winding_fluxes, shorted_winding_drops),
    "split-winding": (split_winding_fluxes, split_winding_drops),
}


def integrate(
    model: str,
    motor: Motor,
    mu: float,
    winding: int,
    load_level: float,
    voltage: Callable[[float], Array],
    start: Array,
    speed: float,
    times: Array,
    method: Literal["DOP853", "Radau", "RK45"] = "DOP853",
    rtol: float = 1e-10,
) -> tuple[Array, Array]:
    """Stator currents (2, times) and electrical speed (times,) from currents `start` (5,) at times[0]."""
    fluxes, drops = PAGES[model]
    columns = np.array([fluxes(motor, mu, winding, unit) for unit in np.eye(5)]).T
    inverse = np.linalg.inv(columns)
    nameplate, p = motor.nameplate, motor.parameters
    pole_pairs = nameplate.pole_pairs
    load = load_level * nameplate.rated_torque_Nm

    def rhs(t: float, y: Array) -> Array:
        z, w = inverse @ y[:5], y[5]
        change = drops(motor, mu, winding, voltage(t), z)
        change[2:4] += w * (J @ y[2:4])
        torque = pole_pairs * (y[3] * z[2] - y[2] * z[3])
        return np.concatenate([change, [pole_pairs / p.inertia_kgm2 * (torque - load)]])

    y0 = np.concatenate([columns @ start, [speed]])
    solution = solve_ivp(
        rhs, (float(times[0]), float(times[-1])), y0, method=method, t_eval=times, rtol=1e-10, atol=1e-12
    )
    assert solution.success, solution.message
    return (inverse @ solution.y[:5])[:2], solution.y[5]
