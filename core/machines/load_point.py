"""Where a sound motor runs at a load: slip and currents in closed form, from its equivalent circuit."""

from dataclasses import dataclass
from math import pi, sqrt

from core.machines.parameters import Motor

LEAST_SHARE = 1e-9
"""Of the rated power: less crosses the air gap of no motor that runs."""


@dataclass(frozen=True, slots=True)
class LoadPoint:
    """Slip and currents of a motor whose torque balances its load.

    Parameters
    ----------
    slip : float
        Slip.
    current_A : complex
        Current of a winding, rms, its voltage in phase with one [A].
    rotor_current_A : complex
        Current of a rotor phase, referred to the stator, rms [A].
    """

    slip: float
    current_A: complex
    rotor_current_A: complex


def load_point(motor: Motor, winding_voltage_V: float, frequency_hz: float, crossing_W: float) -> LoadPoint:
    """Find where a motor runs when so much power crosses its air gap.

    Seen from the rotor, the stator is a voltage V behind R + jX (Thevenin), X with the rotor's leakage. With
    x = R_r / s, the power is P = 3 V^2 x / ((R + x)^2 + X^2), a quadratic equation whose larger root is the
    stable one.

    Parameters
    ----------
    motor : Motor
        Nameplate and parameters of the motor.
    winding_voltage_V : float
        Voltage of a winding, rms [V].
    frequency_hz : float
        Frequency of the supply [Hz].
    crossing_W : float
        Power of all three phases across the air gap: the torque times the synchronous speed [W].

    Returns
    -------
    LoadPoint
        Slip and currents. Where the circuit does not reach the torque, those of its greatest one.
    """
    machine, w = motor.parameters, 2.0 * pi * frequency_hz
    stator = complex(machine.stator_resistance_ohm, w * machine.stator_leakage_H)
    magnetising = 1j * w * machine.magnetising_inductance_H
    divider = magnetising / (stator + magnetising)
    behind = stator * divider + 1j * w * machine.rotor_leakage_H
    power = max(crossing_W, LEAST_SHARE * motor.nameplate.rated_power_W)
    half = 1.5 * (winding_voltage_V * abs(divider)) ** 2 / power - behind.real
    discriminant = half * half - abs(behind) ** 2
    x = half + sqrt(discriminant) if half > 0.0 and discriminant >= 0.0 else abs(behind)
    rotor = winding_voltage_V * divider / (behind + x)
    in_rotor = x + 1j * w * machine.rotor_leakage_H
    return LoadPoint(
        slip=machine.rotor_resistance_ohm / x,
        current_A=rotor * (1.0 + in_rotor / magnetising),
        rotor_current_A=rotor,
    )
