"""What the follower does not know of a motor: what it takes for possible before the first record, and after.

All but E and C are fractions of the motor file's figures. The standing errors are those of file and sensors;
they stay. What has changed since the first records wanders: that is how the follower forgets.
"""

from enum import IntEnum
from math import hypot, sqrt
from typing import Final

import numpy as np

from core.machines.base import Array
from core.machines.parameters import Motor
from core.tracking.circuit import terminal_circuit


class Unknown(IntEnum):
    """Place of each in the follower's state."""

    STATOR_RESISTANCE = 0
    LEAKAGE = 1
    MAGNETISING = 2
    ROTOR_RESISTANCE = 3
    NEGATIVE_LEAKAGE = 4
    """Standing errors of R_s, L_sigma, L_M; of R_R and the leakage as the negative sequence sees them."""
    SATURATION = 5
    """Loss of L_M per relative rise of the voltage over the frequency."""
    HEATING = 6
    """Rise of the resistances with the square of the current over the rated one."""
    WARMTH = 7
    """Resistances beyond that: what the motor did before the record, and the weather."""
    STATOR_RESISTANCE_CHANGE = 8
    LEAKAGE_CHANGE = 9
    MAGNETISING_CHANGE = 10
    ROTOR_RESISTANCE_CHANGE = 11
    """Changes since the first records; that of R_R beyond the change of R_s, as temperature makes none."""
    STARTS = 12
    """Standing error of R_r over R_s as starts tell it."""
    E_REAL = 13
    E_IMAGINARY = 14
    C_REAL = 15
    C_IMAGINARY = 16
    """Standing asymmetry: shares of the voltage and of the current."""


STATES: Final = len(Unknown)
CHANGES: Final = slice(Unknown.STATOR_RESISTANCE_CHANGE, Unknown.ROTOR_RESISTANCE_CHANGE + 1)
ALIKE: Final = np.array([1.0, 1.0, 1.0, 0.0])
"""Changes of all impedances by one factor; the rotor's counts beyond that of R_s."""

WARMTH_DEVIATION, WARMTH_TIME_S = 0.05, 3.0 * 3600.0
"""13 K; how long a winding keeps its temperature."""
WANDER: Final = np.array([2e-3, 3e-4, 5e-4, 3e-3])
"""Standard deviation of what changes from record to record: what is a hundred records old tells little."""
FARTHEST: Final = np.array([0.25, 0.08, 0.10, 0.30])
"""Standard deviation of changes of which the records tell nothing."""
JUMP: Final = np.array([0.10, 0.05, 0.05, 0.10])
JUMP_ALIKE: Final = 0.10
"""The same where records say at once that something is another: each by itself, and all by one factor."""
FILE_TEMPERATURE: Final = 0.2
"""Resistances of a file are those of a cold or of a warm motor."""
OTHER_FREQUENCY: Final = 0.5
"""Of a cage at the supply's frequency and at twice that (skin effect)."""
USUAL_SATURATION, SATURATION_DEVIATION = 0.7, 0.7
USUAL_HEATING, HEATING_DEVIATION = 0.2, 0.12
"""50 K, 30 K."""
ASYMMETRY, ASYMMETRY_WANDER, ASYMMETRY_JUMP = 0.01, 1e-5, 0.01


def first_guess() -> Array:
    """Return the state before the first record.

    Returns
    -------
    ndarray, shape (STATES,)
        State.
    """
    x = np.zeros(STATES)
    x[Unknown.SATURATION], x[Unknown.HEATING] = USUAL_SATURATION, USUAL_HEATING
    return x


def first_covariance(motor: Motor) -> Array:
    """Return how sure the state is before the first record.

    Parameters
    ----------
    motor : Motor
        The motor, with the tolerances of its parameters and the class of its sensors.

    Returns
    -------
    ndarray, shape (STATES, STATES)
        Covariance.
    """
    even = 1.0 / sqrt(3.0)
    of = motor.tolerances
    leakage = even * max(of.stator_leakage_H, of.rotor_leakage_H)
    deviations = {
        Unknown.STATOR_RESISTANCE: hypot(even * of.stator_resistance_ohm, FILE_TEMPERATURE),
        Unknown.LEAKAGE: hypot(leakage, 0.05),
        Unknown.MAGNETISING: hypot(even * of.stator_self_inductance_H, 0.05),
        Unknown.ROTOR_RESISTANCE: hypot(even * of.rotor_resistance_ohm, OTHER_FREQUENCY),
        Unknown.NEGATIVE_LEAKAGE: hypot(leakage, 0.15),
        Unknown.SATURATION: SATURATION_DEVIATION,
        Unknown.HEATING: HEATING_DEVIATION,
        Unknown.WARMTH: WARMTH_DEVIATION,
        Unknown.STARTS: OTHER_FREQUENCY,
    }
    P = np.zeros((STATES, STATES))
    for unknown, deviation in deviations.items():
        P[unknown, unknown] = deviation**2
    return P + _of_sensors(motor) + _of_asymmetry(ASYMMETRY)


def other_sensors(motor: Motor) -> Array:
    """Return what becomes uncertain with other sensors of the same class.

    Parameters
    ----------
    motor : Motor
        The motor.

    Returns
    -------
    ndarray, shape (STATES, STATES)
        Covariance to be added.
    """
    return 2.0 * _of_sensors(motor) + _of_asymmetry(ASYMMETRY)


def of_jump() -> Array:
    """Return what becomes uncertain where records say at once that something is another.

    Returns
    -------
    ndarray, shape (STATES, STATES)
        Covariance to be added.
    """
    P = np.zeros((STATES, STATES))
    P[CHANGES, CHANGES] = np.diag(JUMP**2) + JUMP_ALIKE**2 * np.outer(ALIKE, ALIKE)
    return P


def of_unknown_changes() -> Array:
    """Return how uncertain changes are of which nothing is known.

    Returns
    -------
    ndarray, shape (STATES, STATES)
        Covariance to be added.
    """
    P = np.zeros((STATES, STATES))
    P[CHANGES, CHANGES] = np.diag(FARTHEST**2)
    return P


def of_asymmetry_jump() -> Array:
    """Return what becomes uncertain where the motor's standing asymmetry is another at once.

    Returns
    -------
    ndarray, shape (STATES, STATES)
        Covariance to be added.
    """
    return _of_asymmetry(ASYMMETRY_JUMP)


def kept(elapsed_s: float, *, changes: bool) -> tuple[Array, Array]:
    """Return what is left of each unknown after a while, and the variance that comes to it.

    Parameters
    ----------
    elapsed_s : float
        Time since the record before [s].
    changes : bool
        Whether the parameters may have changed since the first records.

    Returns
    -------
    ndarray, shape (STATES,)
        Factors.
    ndarray, shape (STATES,)
        Variances.
    """
    factors, variances = np.ones(STATES), np.zeros(STATES)
    factors[Unknown.WARMTH] = np.exp(-elapsed_s / WARMTH_TIME_S)
    variances[Unknown.WARMTH] = WARMTH_DEVIATION**2 * (1.0 - factors[Unknown.WARMTH] ** 2)
    variances[Unknown.E_REAL :] = ASYMMETRY_WANDER**2
    if changes:
        variances[CHANGES] = WANDER**2
        factors[CHANGES] = np.sqrt(1.0 - (WANDER / FARTHEST) ** 2)
    return factors, variances


def _of_sensors(motor: Motor) -> Array:
    """Return what a common gain, which scales the circle, and a common delay, which turns it, leave open."""
    sensors, w = motor.sensors, motor.nameplate.rated_angular_frequency
    circuit = terminal_circuit(motor.parameters)
    gain = hypot(sensors.voltage_gain, sensors.current_gain) / 3.0
    angle = w * hypot(sensors.voltage_delay_s, sensors.current_delay_s) / 3.0
    scaled, turned = np.zeros(STATES), np.zeros(STATES)
    scaled[[Unknown.STATOR_RESISTANCE, Unknown.LEAKAGE, Unknown.MAGNETISING]] = gain
    turned[Unknown.STATOR_RESISTANCE] = angle * w * (circuit.L_sigma + 0.5 * circuit.L_M) / circuit.R_s
    turned[Unknown.ROTOR_RESISTANCE] = angle * 2.0 * w * circuit.L_sigma / circuit.R_R
    return np.asarray(np.outer(scaled, scaled) + np.outer(turned, turned) * np.eye(STATES))


def _of_asymmetry(deviation: float) -> Array:
    P = np.zeros((STATES, STATES))
    for unknown in (Unknown.E_REAL, Unknown.E_IMAGINARY, Unknown.C_REAL, Unknown.C_IMAGINARY):
        P[unknown, unknown] = deviation**2
    return P
