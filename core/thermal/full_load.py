"""The full-load current of a motor, from its circuit at rated voltage, frequency and torque."""

from math import pi, sqrt

from core.machines.parameters import Connection, Motor

_HALVINGS = 60


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
    plate, machine = motor.nameplate, motor.parameters
    delta = plate.connection is Connection.DELTA
    voltage = plate.rated_voltage_V if delta else plate.rated_voltage_V / sqrt(3.0)
    w = 2.0 * pi * plate.rated_frequency_Hz
    stator = complex(machine.stator_resistance_ohm, w * machine.stator_leakage_H)
    magnetising = 1j * w * machine.magnetising_inductance_H
    # Thevenin's circuit as the rotor sees it: greatest torque at the slip where R_r/s matches its rest.
    seen = stator * magnetising / (stator + magnetising) + 1j * w * machine.rotor_leakage_H
    R_r = machine.rotor_resistance_ohm
    low, high = 0.0, R_r / abs(seen)
    for _ in range(_HALVINGS):
        slip = (low + high) / 2.0
        rotor = complex(R_r / slip, w * machine.rotor_leakage_H)
        current = voltage / (stator + magnetising * rotor / (magnetising + rotor))
        crossing_W = 3.0 * abs(current * magnetising / (magnetising + rotor)) ** 2 * R_r / slip
        low, high = (slip, high) if crossing_W < plate.rated_power_W else (low, slip)
    return abs(current) * (sqrt(3.0) if delta else 1.0)
