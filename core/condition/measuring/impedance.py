"""The negative-sequence impedance that a motor's file promises."""

from math import pi

from core.machines.parameters import Motor

WARM = 1.2
"""Resistance of a warm winding over that of a cold one: parameters are of either, and this is between."""
NEGATIVE_SEQUENCE_SLIP = 1.98
"""Slip of the rotor against a field that turns backwards, at a slip of 2 % forwards."""


def negative_sequence_impedance(motor: Motor, frequency_hz: float) -> complex:
    """Return Z2, by which a voltage unbalance makes a current unbalance in the healthy motor.

    Parameters
    ----------
    motor : Motor
        The motor.
    frequency_hz : float
        Supply frequency [Hz].

    Returns
    -------
    complex
        Impedance of a phase winding [ohm].
    """
    machine = motor.parameters
    resistance = machine.stator_resistance_ohm + machine.rotor_resistance_ohm / NEGATIVE_SEQUENCE_SLIP
    leakage = machine.stator_leakage_H + machine.rotor_leakage_H
    return complex(WARM * resistance, 2.0 * pi * frequency_hz * leakage)
