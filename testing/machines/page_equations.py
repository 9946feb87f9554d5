"""The equations of the models as they stand on the page, integrated by scipy: slow, independent.

Currents are found from fluxes by solving the flux equations written as a function of the currents, column by
column; nothing of the models' own matrices is used.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from core.machines.parameters import Connection, Motor

Array = NDArray[np.float64]
K = np.sqrt(2.0 / 3.0)
J = np.array([[0.0, -1.0], [1.0, 0.0]])


@dataclass(frozen=True)
class Coil:
    """Where shorted turns lie, and what bridges them.

    own_leakage: share kappa of their leakage that is not linked with the phase.  axis_rad: delta from the
    phase's axis.  linkage: 1 / k_d.  path_ratio: r_f / (mu R_s).
    """

    own_leakage: float = 1.0
    axis_rad: float = 0.0
    linkage: float = 1.0
    path_ratio: float = 0.0

    def leakage_of(self, mu: float) -> float:
        """lambda = kappa + (1 - kappa) mu."""
        return self.own_leakage + (1.0 - self.own_leakage) * mu


ON_PHASE_AXIS = Coil()


def axis(winding: int, beside_rad: float = 0.0) -> Array:
    angle = 2.0 * np.pi / 3.0 * winding + beside_rad
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


def split_winding_current(motor: Motor, mu: float, winding: int, z: Array) -> float:
    """i_x: in delta with a third of the shunt's current, which runs around and never reaches the lines."""
    around = mu * z[4] / 3.0 if motor.nameplate.connection is Connection.DELTA else 0.0
    return float(K * axis(winding) @ z[0:2] + around)


def split_winding_fluxes(
    motor: Motor, mu: float, winding: int, z: Array, coil: Coil = ON_PHASE_AXIS
) -> Array:
    """psi_s, psi_r, psi_x2 of Tallam's model from i_s, i_r, i_f; the field sees the coil's axis."""
    p, n, n_c = motor.parameters, axis(winding), coil.linkage * axis(winding, coil.axis_rad)
    i_s, i_r, i_f = z[0:2], z[2:4], z[4]
    i_x = split_winding_current(motor, mu, winding, z)
    psi_m = p.magnetising_inductance_H * (i_s - K * n_c * mu * i_f + i_r)
    psi_s = p.stator_leakage_H * (i_s - K * n * mu * i_f) + psi_m
    psi_x2 = mu * (p.stator_leakage_H * (i_x - coil.leakage_of(mu) * i_f) + K * n_c @ psi_m)
    return np.concatenate([psi_s, p.rotor_leakage_H * i_r + psi_m, [psi_x2]])


def split_winding_drops(
    motor: Motor, mu: float, winding: int, v: Array, z: Array, coil: Coil = ON_PHASE_AXIS
) -> Array:
    """Voltages that change the fluxes; of the loop r_f i_f - mu R_s (i_x - i_f)."""
    p, n = motor.parameters, axis(winding)
    i_s, i_r, i_f = z[0:2], z[2:4], z[4]
    return np.concatenate(
        [
            v - p.stator_resistance_ohm * (i_s - K * n * mu * i_f),
            -p.rotor_resistance_ohm * i_r,
            [
                mu * p.stator_resistance_ohm * coil.path_ratio * i_f
                - mu * p.stator_resistance_ohm * (split_winding_current(motor, mu, winding, z) - i_f)
            ],
        ]
    )


def healthy_fluxes(motor: Motor, mu: float, winding: int, z: Array) -> Array:
    """psi_s, psi_r of thesis 3.14 and 3.15 from i_s, i_r; the fifth is idle."""
    p, i_s, i_r = motor.parameters, z[0:2], z[2:4]
    psi_m = p.magnetising_inductance_H * (i_s + i_r)
    return np.concatenate([p.stator_leakage_H * i_s + psi_m, p.rotor_leakage_H * i_r + psi_m, z[4:]])


def healthy_drops(motor: Motor, mu: float, winding: int, v: Array, z: Array) -> Array:
    p = motor.parameters
    return np.concatenate(
        [
            v - p.stator_resistance_ohm * z[0:2],
            -p.rotor_resistance_ohm * z[2:4],
            [-p.stator_resistance_ohm * z[4]],
        ]
    )


def high_resistance_fluxes(motor: Motor, mu: float, winding: int, z: Array) -> Array:
    """The healthy machine's; the fifth current is the delta's zero sequence i_0 through the leakage."""
    fluxes = healthy_fluxes(motor, mu, winding, z)
    fluxes[4] = motor.parameters.stator_leakage_H * z[4]
    return fluxes


def high_resistance_drops(motor: Motor, mu: float, winding: int, v: Array, z: Array) -> Array:
    """mu R_s in series with one winding: a drop along its axis, and in a delta around the loop."""
    p, n = motor.parameters, axis(winding)
    delta = motor.nameplate.connection is Connection.DELTA
    i_x = K * n @ z[0:2] + (z[4] / np.sqrt(3.0) if delta else 0.0)
    drop = mu * p.stator_resistance_ohm * i_x
    around = drop / np.sqrt(3.0) if delta else 0.0
    added = np.concatenate([K * n * drop, [0.0, 0.0, around]])
    return np.asarray(healthy_drops(motor, mu, winding, v, z) - added, dtype=np.float64)


PAGES = {
    "healthy": (healthy_fluxes, healthy_drops),
    "shorted-winding": (shorted_winding_fluxes, shorted_winding_drops),
    "split-winding": (split_winding_fluxes, split_winding_drops),
    "high-resistance": (high_resistance_fluxes, high_resistance_drops),
}


def axis_resistance_growth(broken_share: float) -> float:
    """alpha / (1 - alpha), alpha = 2 n_bb / N_b: rotor resistance along the broken bars' axis, relative."""
    alpha = 2.0 * broken_share
    return alpha / (1.0 - alpha)


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
    *,
    load_exponent: int = 0,
    broken_share: float = 0.0,
    coil: Coil | None = None,
) -> tuple[Array, Array]:
    """Stator currents (2, times) and electrical speed (times,) from currents `start` (5,) at times[0].

    load_exponent: of the speed in the load torque; broken_share: n_bb / N_b, their axis on alpha at times[0].
    coil: of the split winding.
    """
    fluxes, drops = PAGES[model]
    if coil is not None:
        fluxes, drops = partial(split_winding_fluxes, coil=coil), partial(split_winding_drops, coil=coil)
    columns = np.array([fluxes(motor, mu, winding, unit) for unit in np.eye(5)]).T
    inverse = np.linalg.inv(columns)
    off = np.zeros(2)
    decay = np.array([drops(motor, mu, winding, off, unit) for unit in np.eye(5)]).T @ inverse
    nameplate, p = motor.nameplate, motor.parameters
    pole_pairs = nameplate.pole_pairs
    rated_load = load_level * nameplate.rated_torque_Nm
    added_resistance = p.rotor_resistance_ohm * axis_resistance_growth(broken_share)

    def rhs(t: float, y: Array) -> Array:
        z, w, angle = inverse @ y[:5], y[5], y[6]
        change = decay @ y[:5]
        change[0:2] += voltage(t)
        change[2:4] += w * (J @ y[2:4])
        if added_resistance:
            q = np.array([np.cos(angle), np.sin(angle)])
            change[2:4] -= added_resistance * q * (q @ z[2:4])
        torque = pole_pairs * (y[3] * z[2] - y[2] * z[3])
        load = rated_load * (w / nameplate.rated_angular_frequency) ** load_exponent
        return np.concatenate([change, [pole_pairs / p.inertia_kgm2 * (torque - load), w]])

    y0 = np.concatenate([columns @ start, [speed, 0.0]])
    solution = solve_ivp(
        rhs, (float(times[0]), float(times[-1])), y0, method=method, t_eval=times, rtol=rtol, atol=1e-2 * rtol
    )
    assert solution.success, solution.message
    return (inverse @ solution.y[:5])[:2], solution.y[5]
