"""The load of a motor from the phasors of its record."""

from core.diagnosis.fundamental import Fundamental
from core.machines.parameters import Motor


def load_of(record: Fundamental, motor: Motor) -> float:
    """Return the load whose torque crosses the air gap.

    T_e = p (Re(v i*) - R_s |i|^2) / w_s, of the forward-turning phasors (power-invariant space vectors).
    """
    current, voltage = record.current.forward, record.voltage.forward
    nameplate = motor.nameplate
    crossing = (voltage * current.conjugate()).real - motor.parameters.stator_resistance_ohm * abs(
        current
    ) ** 2
    torque = nameplate.pole_pairs * crossing / record.angular_frequency
    return torque / nameplate.rated_torque_Nm
