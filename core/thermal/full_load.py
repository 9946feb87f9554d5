"""The full-load current of a motor, from its circuit at rated voltage, frequency and torque."""

from math import sqrt

from core.machines.load_point import load_point
from core.machines.parameters import Connection, Motor


def full_load_current_A(motor: Motor) -> float:
    """Return the line current at rated torque.

    Parameters
    ----------
    motor : Motor
        Nameplate and parameters of the motor.

    Returns
    -------
    float
        Current, rms [A]. Where the circuit does not reach rated torque, that of its greatest torque.
    """
    plate = motor.nameplate
    rated = load_point(motor, plate.winding_voltage_V, plate.rated_frequency_Hz, plate.rated_power_W)
    return abs(rated.current_A) * (sqrt(3.0) if plate.connection is Connection.DELTA else 1.0)
