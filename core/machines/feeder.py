"""From the relay's transformers to the motor, where its file tells what lies between: capacitors, a cable.

The motor's own currents and voltages follow from the measured ones, on Clarke axes, by Kirchhoff's laws:

    i = i_measured - C dv/dt,    v = v_measured - R i - L di/dt

with C, R and L of one line. They are the same in the positive and the negative sequence; of the zero sequence
three wires carry nothing.
"""

from math import sin

import numpy as np

from core.machines.base import Array
from core.machines.parameters import Motor
from core.signals.clarke import CLARKE


def has_feeder(motor: Motor) -> bool:
    """Whether a motor's currents or voltages are others than the measured ones.

    Parameters
    ----------
    motor : Motor
        The motor.

    Returns
    -------
    bool
        Whether its file tells of capacitors that are measured with it, or of a cable.
    """
    return motor.cable is not None or _capacitance_F(motor) > 0.0


def at_the_motor(
    motor: Motor, current_abc: Array, voltage_ab: Array, sample_rate_hz: float
) -> tuple[Array, Array]:
    """Return the motor's own currents and voltages.

    Parameters
    ----------
    motor : Motor
        The motor.
    current_abc : ndarray, shape (3, n)
        Measured line currents [A].
    voltage_ab : ndarray, shape (2, n)
        Measured voltages, line to neutral, on Clarke axes [V].
    sample_rate_hz : float
        Sampling rate [Hz].

    Returns
    -------
    current_abc : ndarray, shape (3, n)
        Line currents of the motor [A].
    voltage_ab : ndarray, shape (2, n)
        Voltages at its terminals [V].
    """
    w = motor.nameplate.rated_angular_frequency
    step = w / sample_rate_hz
    # The quotient of differences is exact at the supply's frequency.
    slope = sample_rate_hz * step / sin(step) if step < 1.0 else sample_rate_hz
    current_abc = current_abc - CLARKE.T @ (_capacitance_F(motor) * slope * np.gradient(voltage_ab, axis=1))
    cable = motor.cable
    if cable is not None:
        current_ab = CLARKE @ current_abc
        drop = cable.resistance_ohm * current_ab
        drop += cable.reactance_ohm / w * slope * np.gradient(current_ab, axis=1)
        voltage_ab = voltage_ab - drop
    return current_abc, voltage_ab


def susceptance_S(motor: Motor, kvar: float) -> float:
    """Return the susceptance of a bank in one line, as a star that is equal to it.

    Parameters
    ----------
    motor : Motor
        The motor.
    kvar : float
        Reactive power at its rated voltage and frequency [kvar].

    Returns
    -------
    float
        Susceptance at rated frequency [S].
    """
    return 1e3 * kvar / motor.nameplate.rated_voltage_V**2


def _capacitance_F(motor: Motor) -> float:
    bank = motor.capacitors
    if bank is None or motor.transformers.inside_delta:
        return 0.0
    return susceptance_S(motor, bank.kvar) / motor.nameplate.rated_angular_frequency
