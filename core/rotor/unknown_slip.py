"""Asymmetry of a rotor whose slip is unknown, because the resistance at its rings is.

A pair of lines at Omega is either that of an uneven rotor at the slip Omega / 2, or that of a load that
swings at another slip. With lambda = s w_s / R known from the torque, a ripple of the speed alone makes

    upper:  j w Psi_r / R = i_r + j (lambda + Omega / R) psi_r
    lower:  j conj(w) Psi_r / R = i_r + j (lambda - Omega / R) psi_r

so what a ripple leaves of the lower line is C + D / R, and the least of it over all R that may be is what no
swing of the load explains. (`core.rotor.rotor_circuit` has the same for the slip Omega / 2.)
"""

import numpy as np

from core.machines.base import Array
from core.machines.parameters import Motor
from core.machines.wound_rotor import resistance_ratios
from core.rotor.rotor_circuit import rotor_side
from core.rotor.running_point import RunningPoint
from core.rotor.sidebands import Lines

BEYOND_THE_RANGE = 1.25
"""Factor by which a winding that is warm or cold is beyond the range of its resistance."""


def beyond_a_ripple(lines: Lines, distance: Array, point: RunningPoint, motor: Motor) -> Array:
    """Return what a ripple of the speed at any slip leaves of pairs of lines.

    Parameters
    ----------
    lines : Lines
        Amplitudes of voltage and current.
    distance : ndarray, shape (pairs,)
        Omega, the distance of each pair from the fundamental [rad/s].
    point : RunningPoint
        Operating point as the motor's parameters see it.
    motor : Motor
        The running motor, whose rotor resistance is within a range.

    Returns
    -------
    ndarray, shape (pairs,)
        The least of it, as an asymmetry of the rotor's resistance.
    """
    machine, w_s, lam = motor.parameters, point.angular_frequency, point.slip_over_resistance
    _, i_r_upper, psi_r_upper = rotor_side(lines.upper, w_s + distance, machine)
    _, i_r_lower, psi_r_lower = rotor_side(lines.lower, w_s - distance, machine)
    # The upper line gives w: j conj(w) Psi_r is -Psi_r / conj(Psi_r) times the conjugate of its right side.
    turn = -point.rotor_flux / point.rotor_flux.conjugate()
    C = turn * (i_r_upper + 1j * lam * psi_r_upper).conj() - (i_r_lower + 1j * lam * psi_r_lower)
    D = distance * (turn * (1j * psi_r_upper).conj() + 1j * psi_r_lower)
    least, most = (ratio * machine.rotor_resistance_ohm for ratio in resistance_ratios(motor))
    conductance = np.clip(
        -(C * D.conj()).real / np.abs(D) ** 2, 1.0 / (BEYOND_THE_RANGE * most), BEYOND_THE_RANGE / least
    )
    return np.asarray(np.abs(C + D * conductance) / abs(point.rotor_current))
