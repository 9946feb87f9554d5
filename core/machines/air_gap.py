"""Flux, torque and slip of a machine that starts from rest, by its terminal quantities.

    psi_s = integral of (v - R_s i)          from rest, where there is no flux
    T     = p psi_s x i
    s     = -R_r i_r / (j w psi_r)           phasors of the positive sequence

In the first cycles after the switching the slip means nothing.
"""

from dataclasses import dataclass
from math import pi
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from core.machines.base import Array
from core.machines.parameters import MachineParameters

Complex = NDArray[np.complex128]

UNSETTLED_CYCLES: Final = 3
"""Cycles after the switching in which currents decay that are not the supply's."""


@dataclass(frozen=True, slots=True)
class AirGap:
    """What the air gap of a starting machine does, sample by sample from the switching on.

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
        Slip by the phasors of rotor current and flux, of two cycles about the sample.
    """

    sample_rate_hz: float
    cycle: int
    frequency_hz: float
    voltage_ab: Array
    current_ab: Array
    torque_Nm: Array
    slip: Array


def air_gap(
    voltage_ab: Array,
    current_ab: Array,
    *,
    sample_rate_hz: float,
    frequency_hz: float,
    pole_pairs: int,
    machine: MachineParameters,
) -> AirGap:
    """Integrate flux and torque.

    Parameters
    ----------
    voltage_ab, current_ab : ndarray, shape (2, n)
        Winding quantities of positive sequence on Clarke axes, from the switching on, without offsets [V, A].
    sample_rate_hz, frequency_hz : float
        Sampling rate and supply frequency [Hz].
    pole_pairs : int
        Number of pole pairs p.
    machine : MachineParameters
        Parameters of the machine.

    Returns
    -------
    AirGap
        Torque and slip.
    """
    p, cycle = pole_pairs, round(sample_rate_hz / frequency_hz)
    emf = voltage_ab - machine.stator_resistance_ohm * current_ab
    psi_s = np.zeros_like(emf)
    np.cumsum((emf[:, 1:] + emf[:, :-1]) / (2.0 * sample_rate_hz), axis=1, out=psi_s[:, 1:])
    torque = p * (psi_s[0] * current_ab[1] - psi_s[1] * current_ab[0])

    slip = _slip(voltage_ab, current_ab, machine, 2.0 * pi * frequency_hz, cycle, sample_rate_hz)
    return AirGap(sample_rate_hz, cycle, frequency_hz, voltage_ab, current_ab, torque, slip)


def _slip(v: Array, i: Array, machine: MachineParameters, w: float, cycle: int, rate_hz: float) -> Array:
    """Return the slip by the phasors of the positive sequence, each over two cycles about the sample."""
    L_m = machine.magnetising_inductance_H
    L_s, L_r = L_m + machine.stator_leakage_H, L_m + machine.rotor_leakage_H
    turn = np.exp(-1j * w / rate_hz * np.arange(v.shape[1]))
    v_1, i_1 = (positive_sequence((x[0] + 1j * x[1]) * turn, cycle) for x in (v, i))
    psi_s = (v_1 - machine.stator_resistance_ohm * i_1) / (1j * w)
    i_r = (psi_s - L_s * i_1) / L_m
    psi_r = L_m * i_1 + L_r * i_r
    return np.asarray(-(machine.rotor_resistance_ohm * i_r / (1j * w * psi_r)).real)


def positive_sequence(turned: Complex, cycle: int) -> Complex:
    """Average a space vector that was turned back with the supply.

    Twice over one cycle: direct current and the other sequence drop out, even while they decay.

    Parameters
    ----------
    turned : ndarray of complex, shape (n,)
        Space vector times exp(-j w t).
    cycle : int
        Samples in one cycle.

    Returns
    -------
    ndarray of complex, shape (n,)
        Its mean about each sample.
    """
    parts = (uniform_filter1d(uniform_filter1d(x, cycle), cycle) for x in (turned.real, turned.imag))
    real, imaginary = parts
    mean: Complex = real + 1j * imaginary
    return mean
