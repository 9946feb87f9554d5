"""What is known of a motor before its first record: how far sensors, parameters and windings may be off."""

from dataclasses import dataclass
from math import hypot, pi, sqrt

import numpy as np

from core.condition.filter.kalman import TEMPERATURE
from core.condition.observation import VoltageChannels
from core.diagnosis.channel_errors import terminal_turn, voltage_channels
from core.diagnosis.tolerance import negative_impedance_deviation
from core.machines.base import Array
from core.machines.parameters import Motor

OWN_VOLTAGE = 0.001
"""Standard deviation of a sound winding's own asymmetry, a share of the voltage (complex magnitude)."""
OWN_CURRENT = 0.002
"""Standard deviation of what a sound motor adds in proportion to its current (complex magnitude)."""
IMPEDANCE = 0.15
"""Standard deviation of the real and of the imaginary part of Z2's error over |Z2|, where the parameters are
within the usual tolerance."""
SATURATION_SPREAD = 1.5
"""Standard deviation of the loss of magnetising inductance per rise of the flux, both relative. It is wider
than the usual loss (`core.diagnosis.priors.SATURATION`), because the records show the motor's own."""


@dataclass(frozen=True, slots=True)
class Prior:
    """Spread of the standing errors before the first record.

    Parameters
    ----------
    channels : ndarray, shape (2, 2)
        Covariance of what the voltage channels add to the real and the imaginary part of E.
    own : ndarray, shape (2, 2)
        Covariance of what a sound winding adds.
    current : float
        Standard deviation of each part of C: sqrt(s_I^2/3 + 0.002^2) / sqrt 2.
    impedance : float
        Standard deviation of each part of Z2's error over |Z2|.
    circle : tuple of float
        Standard deviations of what moves the current off its circle; see `core.condition.filter.circle`.
    """

    channels: Array
    own: Array
    current: float
    impedance: float
    circle: tuple[float, ...]

    @property
    def voltage(self) -> Array:
        """Covariance of E, shape (2, 2)."""
        return self.channels + self.own


def prior_of(motor: Motor, channels: VoltageChannels) -> Prior:
    """Return what is known of a motor's standing errors from its file alone.

    Parameters
    ----------
    motor : Motor
        The motor, with the class of its sensors.
    channels : VoltageChannels
        Which voltages are measured.

    Returns
    -------
    Prior
        Spread of the standing errors.
    """
    f, sensors = motor.nameplate.rated_frequency_Hz, motor.sensors
    gain = sensors.voltage_gain / sqrt(3.0)
    angle = 2.0 * pi * f * sensors.voltage_delay_s / sqrt(3.0)
    turn = terminal_turn(motor)
    spread = np.zeros((2, 2))
    for e in voltage_channels(channels):
        u = e * turn
        along, across = np.array([u.real, u.imag]), np.array([-u.imag, u.real])
        spread += gain**2 * np.outer(along, along) + angle**2 * np.outer(across, across)
    if channels is VoltageChannels.TWO_LINES:
        # Two channels of the same size lie on one of three lines, it is not known which.
        spread *= 2.0 / 3.0
    return Prior(
        channels=spread,
        own=0.5 * OWN_VOLTAGE**2 * np.eye(2),
        current=sqrt(0.5) * hypot(sensors.current_deviation(f) / sqrt(3.0), OWN_CURRENT),
        impedance=max(IMPEDANCE, negative_impedance_deviation(motor)),
        circle=(
            1.0,
            1.0,
            motor.tolerances.stator_resistance_ohm,
            motor.tolerances.stator_leakage_H,
            motor.tolerances.stator_self_inductance_H,
            SATURATION_SPREAD,
            TEMPERATURE,
            0.0,
            0.0,
        ),
    )
