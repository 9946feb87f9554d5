"""Estimation of the load from phasors, so that a fit can begin without a search."""

import numpy as np

from core.diagnosis.fundamental import Fundamental
from core.machines.candidates import Candidates
from core.machines.parameters import Motor

FAULT_LEVEL = 0.02
"""Large enough for the fit to see which way to go, small enough not to bend the load."""


def load_of(record: Fundamental, motor: Motor) -> float:
    """Return the load whose torque crosses the air gap.

    T_e = p (Re(v i*) - R_s |i|^2) / w_s, of the forward-turning phasors (power-invariant space vectors).

    Parameters
    ----------
    record : Fundamental
        Phasors of currents and voltages.
    motor : Motor
        Nameplate and parameters of the motor.

    Returns
    -------
    float
        Torque over rated torque.
    """
    current, voltage = record.current.forward, record.voltage.forward
    nameplate = motor.nameplate
    crossing = (voltage * current.conjugate()).real - motor.parameters.stator_resistance_ohm * abs(
        current
    ) ** 2
    torque = nameplate.pole_pairs * crossing / record.angular_frequency
    return torque / nameplate.rated_torque_Nm


def from_phasors(record: Fundamental, motor: Motor, winding: int) -> Candidates:
    """Make a candidate with the load whose torque crosses the air gap, without offset.

    Parameters
    ----------
    record : Fundamental
        Phasors of currents and voltages.
    motor : Motor
        Nameplate, parameters, channel names and limits of the motor.
    winding : int
        0, 1 or 2 in the winding frame.

    Returns
    -------
    Candidates
        The candidate.
    """
    return Candidates(
        fault_level=np.full(1, FAULT_LEVEL),
        winding=np.full(1, winding, dtype=np.int64),
        load_level=np.full(1, load_of(record, motor)),
        time_offset_s=np.zeros(1),
        path_ratio=np.zeros(1),
    )
