"""What a start does to the motor: its heating against what the rotor withstands, and starts within an hour.

The rotor's limit is the heat of the locked-rotor current over the time for which the motor withstands it. Its
data sheet says both. Where the motor file has neither, the current follows from the parameters, and the time
is the least that NEMA MG 1-12.49 demands of motors of up to 500 hp and 1 kV: 12 s from running temperature.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from math import sqrt
from typing import Final

from core.machines.parameters import Motor
from core.quality.circle_diagram import circle_diagram
from core.starts.examined import StartStress
from core.starts.figures import MotorStart

NEMA_STALL_S: Final = 12.0
"""Least time for which a motor withstands its locked-rotor current when hot (NEMA MG 1-12.49) [s]."""
NEMA_MOST_POWER_W: Final = 500.0 * 745.7
NEMA_MOST_VOLTAGE_V: Final = 1000.0
HOUR_NS: Final = 3_600_000_000_000


def start_stress(start: MotorStart, motor: Motor) -> StartStress:
    """Compare the heating of a start with what the rotor withstands.

    Parameters
    ----------
    start : MotorStart
        Figures of the start.
    motor : Motor
        Nameplate, parameters and limits of the motor.

    Returns
    -------
    StartStress
        The heating.
    """
    limits, plate = motor.start_limits, motor.nameplate
    hot_s, cold_s = limits.locked_rotor_hot_s, limits.locked_rotor_cold_s
    source = "motor file"
    if hot_s is None and cold_s is None:
        if plate.rated_power_W > NEMA_MOST_POWER_W or plate.rated_voltage_V > NEMA_MOST_VOLTAGE_V:
            return StartStress(
                None,
                None,
                None,
                None,
                "not known: the motor file has no locked_rotor_hot_s, and NEMA MG 1-12.49 says nothing of "
                "motors above 500 hp or 1 kV",
                limits.starts_per_hour,
            )
        hot_s, source = NEMA_STALL_S, "NEMA MG 1-12.49: at least 12 s hot"
    current_A = limits.locked_rotor_current_A
    if current_A is None:
        current_A = locked_rotor_current_A(motor)
        source += f", current of the locked rotor from the parameters ({current_A:.4g} A)"
    hot, cold = (None if time_s is None else current_A**2 * time_s for time_s in (hot_s, cold_s))
    return StartStress(
        hot,
        cold,
        None if hot is None else start.i2t_A2s / hot,
        None if cold is None else start.i2t_A2s / cold,
        source,
        limits.starts_per_hour,
    )


def locked_rotor_current_A(motor: Motor) -> float:
    """Return the current with the rotor locked at rated voltage, by the motor's parameters.

    Parameters
    ----------
    motor : Motor
        Nameplate and parameters of the motor.

    Returns
    -------
    float
        Line current, rms [A].
    """
    volts = motor.nameplate.rated_voltage_V / sqrt(3.0)
    return circle_diagram(motor, motor.nameplate.rated_frequency_Hz).at_standstill * volts


def starts_within_hour(times_ns: Sequence[int], time_ns: int) -> int:
    """Count the starts in the hour that ends with one of them.

    Parameters
    ----------
    times_ns : sequence of int
        Times of starts, in their order [ns].
    time_ns : int
        Time of the start that is looked at [ns]; it counts.

    Returns
    -------
    int
        Starts after that time less an hour, up to it.
    """
    return bisect_right(times_ns, time_ns) - bisect_left(times_ns, time_ns - HOUR_NS + 1)
