"""A balanced supply at rated voltage, assumed for records without voltages and in step with the currents.

An unbalanced supply then looks like a fault, so the verdict is never better than "watch". The voltage's
direction against the current is unknown and found like a sensors' delay.
"""

from math import radians

import numpy as np

from core.machines.base import Array
from core.machines.parameters import Nameplate
from core.signals.clarke import clarke
from core.signals.phasors import fundamental_frequency, fundamental_phasors
from core.signals.sequence import PhaseSequence, sequence_phasors

USUAL_LAG_DEG = 50.0
"""Lag of the current behind the voltage at which the search for the true lag begins."""
SUPPLY_UNBALANCE = 0.01
"""Standard deviation of the voltage unbalance (EN 50160: 2 %).

Without recorded voltages an unbalance cannot be distinguished from a fault.
"""


def assumed_voltage(current_abc: Array, sample_rate_hz: float, nameplate: Nameplate) -> Array:
    """Make a balanced supply at rated voltage, in step with the currents.

    Parameters
    ----------
    current_abc : ndarray, shape (3, n)
        Line currents of terminals a, b, c [A].
    sample_rate_hz : float
        Sampling rate [Hz].
    nameplate : Nameplate
        Rated values of the motor.

    Returns
    -------
    ndarray, shape (2, n)
        Voltages on Clarke axes [V].

    Raises
    ------
    SignalError
        If the currents have no fundamental.
    """
    current_ab = clarke(current_abc)
    frequency = fundamental_frequency(current_ab, sample_rate_hz, search_hz=nameplate.frequency_range_Hz)
    phasors = sequence_phasors(fundamental_phasors(current_ab, frequency, sample_rate_hz))
    backwards = phasors.sequence is PhaseSequence.ACB
    strong = phasors.negative if backwards else phasors.positive
    angle = 2.0 * np.pi * frequency / sample_rate_hz * np.arange(current_abc.shape[1])
    angle += np.angle(strong) + radians(USUAL_LAG_DEG)
    volts = nameplate.rated_voltage_V
    turn = -1.0 if backwards else 1.0
    return volts * np.stack([np.cos(angle), turn * np.sin(angle)])
