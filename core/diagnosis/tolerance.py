"""How far the parameters of a motor's file leave its negative-sequence impedance open."""

from math import hypot

from core.machines.parameters import Motor, ParameterTolerances

PARAMETERS = 0.06
"""Standard deviation of the negative-sequence impedance of a machine whose parameters are within the usual
tolerance of 10 %, uniformly. Windings warm up, data sheets round off."""


def negative_impedance_deviation(motor: Motor) -> float:
    """Return the standard deviation of a machine's negative-sequence impedance."""
    return PARAMETERS * (_weighted(motor, motor.tolerances) / _weighted(motor, ParameterTolerances()))


def _weighted(motor: Motor, tolerances: ParameterTolerances) -> float:
    """Root of the sum of squares of the tolerances, each weighed by its part in the impedance [ohm]."""
    machine, w = motor.parameters, motor.nameplate.rated_angular_frequency
    return hypot(
        tolerances.stator_resistance_ohm * machine.stator_resistance_ohm,
        tolerances.rotor_resistance_ohm * machine.rotor_resistance_ohm / 2.0,
        tolerances.stator_leakage_H * w * machine.stator_leakage_H,
        tolerances.rotor_leakage_H * w * machine.rotor_leakage_H,
    )
