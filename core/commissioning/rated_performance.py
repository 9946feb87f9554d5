"""What a catalogue says of a motor, computed from its circuit, per unit of rated voltage and power."""

from math import sqrt

import numpy as np

from core.machines.base import Array

R_S, R_R, X_L, X_M, SKIN, SATURATION, OTHER, SLIP = range(8)
"""Places of the unknowns in `performance`."""
SLIPS = np.geomspace(2e-3, 1.0, 300)
"""At which the greatest torque is looked for."""
LEAST_SPEED = 1e-3
"""A fit on its way may try a slip of one, at which no rated torque is."""


def performance(x: Array) -> dict[str, float]:
    """Compute what a catalogue says from a circuit, per unit of rated voltage and power.

    Parameters
    ----------
    x : ndarray, shape (8,)
        Logarithms of R_s, R_r', X_ls = X_lr', X_m (per unit of V^2 / P), k_R, k_X, the share of the losses
        that are not of the windings, and the rated slip.

    Returns
    -------
    dict of str to float
        Output, efficiency, power factor, current, and locked and greatest currents and torques over the
        rated ones.
    """
    R_s, R_r, X_l, X_m, skin, saturation, other, slip = np.exp(x).tolist()
    current, rotor = _currents(R_s, R_r / slip, X_l, X_m)
    copper = R_s * abs(current) ** 2 + R_r * abs(rotor) ** 2
    further = copper * other / max(1.0 - other, 1e-3)
    torque = abs(rotor) ** 2 * R_r / slip
    output = torque * (1.0 - slip) - further / 2.0
    power = current.real + further / 2.0
    line = abs(current + further / 2.0)
    at_shaft = output / max(1.0 - slip, LEAST_SPEED)
    locked, of_rotor = _currents(R_s, R_r * skin, X_l * saturation, X_m)
    torques = [_torque(R_s, R_r, X_l * sqrt(saturation), X_m, skin, one) for one in SLIPS.tolist()]
    return {
        "output": output,
        "efficiency": output / power,
        "power_factor": power / line,
        "rated_current_A": line,
        "rated_speed_rpm": 1.0 - slip,
        "locked_rotor_current": abs(locked) / line,
        "locked_rotor_torque": abs(of_rotor) ** 2 * R_r * skin / at_shaft,
        "breakdown_torque": max(torques) / at_shaft,
        "stator_resistance_ohm": R_s,
    }


def _currents(R_s: float, rotor_resistance: float, X_l: float, X_m: float) -> tuple[complex, complex]:
    """Return the currents of stator and rotor at rated voltage, per unit."""
    rotor, magnetising = complex(rotor_resistance, X_l), 1j * X_m
    current = 1.0 / (complex(R_s, X_l) + magnetising * rotor / (magnetising + rotor))
    return current, current * magnetising / (magnetising + rotor)


def _torque(R_s: float, R_r: float, X_l: float, X_m: float, skin: float, slip: float) -> float:
    """Return the torque at a slip; the cage's resistance grows with its frequency."""
    resistance = R_r * (1.0 + (skin - 1.0) * slip)
    return abs(_currents(R_s, resistance / slip, X_l, X_m)[1]) ** 2 * resistance / slip
