"""What is known of a motor before its first record: how far sensors, parameters and windings may be off."""

from dataclasses import dataclass
from math import hypot, sqrt

from core.condition.measurement import negative_impedance
from core.machines.parameters import Motor
from core.machines.sensors import SensorClass

OWN_VOLTAGE = 0.001
"""Standard deviation of a sound winding's own asymmetry, a share of the voltage (complex magnitude)."""
OWN_CURRENT = 0.002
"""Standard deviation of what a sound motor adds in proportion to its current (complex magnitude)."""
IMPEDANCE = 0.15
"""Standard deviation of the real and of the imaginary part of Z2's error over |Z2|."""


@dataclass(frozen=True, slots=True)
class Prior:
    """Standard deviations of the standing errors before the first record.

    Parameters
    ----------
    scale_ohm : float
        z = |Z2n| at rated frequency [ohm].
    voltage : float
        Of each part of E, and own part of a channel: sqrt(s_V^2/3 + 0.001^2) / sqrt 2.
    current : float
        Of each part of C: sqrt(s_I^2/3 + 0.002^2) / sqrt 2.
    own_voltage, own_current : float
        Of each part of E and C without the channels.
    """

    scale_ohm: float
    voltage: float
    current: float
    own_voltage: float
    own_current: float


def prior_of(motor: Motor) -> Prior:
    """Return what is known of a motor's standing errors from its file alone.

    Parameters
    ----------
    motor : Motor
        The motor, with the class of its sensors.

    Returns
    -------
    Prior
        Standard deviations.
    """
    f = motor.nameplate.rated_frequency_Hz
    sensors: SensorClass = getattr(motor, "sensors", SensorClass())
    s_V, s_I = sensors.voltage_deviation(f), sensors.current_deviation(f)
    half = sqrt(0.5)
    return Prior(
        scale_ohm=abs(negative_impedance(motor.parameters, f)),
        voltage=half * hypot(s_V / sqrt(3.0), OWN_VOLTAGE),
        current=half * hypot(s_I / sqrt(3.0), OWN_CURRENT),
        own_voltage=half * OWN_VOLTAGE,
        own_current=half * OWN_CURRENT,
    )
