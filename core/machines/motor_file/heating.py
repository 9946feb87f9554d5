"""How hot a motor may get, as its file says: by its starts, and by its relay's thermal element."""

from math import sqrt

from core.machines import plausibility
from core.machines.motor_file.table import MotorTable
from core.machines.parameters import Nameplate, StartLimits, ThermalElement

SERVICE_FACTOR = (1.01, 1.5)
LOCKED_ROTOR_CURRENT = (2.5, 12.0)
ACCELERATION_FACTOR = (0.1, 1.5)
TIME_CONSTANT_S = (60.0, 360_000.0)
"""Ranges of the settings in SEL's motor relays, 49M of SEL-710 and SEL-749M."""
FULL_LOAD_CURRENT = (0.1, 10.0)
"""Over rated power divided by sqrt(3) times rated voltage."""


def start_limits(table: MotorTable, nameplate: Nameplate) -> StartLimits:
    """Read what starts may do to a motor.

    Parameters
    ----------
    table : MotorTable
        The table [limits].
    nameplate : Nameplate
        Rated values of the motor.

    Returns
    -------
    StartLimits
        The limits.
    """
    base_A = nameplate.rated_power_W / (sqrt(3.0) * nameplate.rated_voltage_V)
    least, most = plausibility.LOCKED_ROTOR_CURRENT
    return StartLimits(
        locked_rotor_current_A=table.optional_number(
            "locked_rotor_current_A", (least * base_A, most * base_A), unit="A"
        ),
        locked_rotor_hot_s=table.optional_number("locked_rotor_hot_s", plausibility.LOCKED_ROTOR_S, unit="s"),
        locked_rotor_cold_s=table.optional_number(
            "locked_rotor_cold_s", plausibility.LOCKED_ROTOR_S, unit="s"
        ),
        starts_per_hour=table.optional_count("starts_per_hour", plausibility.MOST_STARTS_PER_HOUR),
    )


def thermal_element(table: MotorTable, nameplate: Nameplate) -> ThermalElement | None:
    """Read the settings of the relay's thermal element.

    Parameters
    ----------
    table : MotorTable
        The table [thermal].
    nameplate : Nameplate
        Rated values of the motor.

    Returns
    -------
    ThermalElement or None
        The settings; None where the file has none.
    """
    if table.is_empty:
        return None
    base_A = nameplate.rated_power_W / (sqrt(3.0) * nameplate.rated_voltage_V)
    least, most = FULL_LOAD_CURRENT
    return ThermalElement(
        service_factor=table.number("service_factor", SERVICE_FACTOR),
        locked_rotor_current=table.number(
            "locked_rotor_current", LOCKED_ROTOR_CURRENT, "2.5 to 12 times the full-load current"
        ),
        locked_rotor_hot_s=table.number("locked_rotor_hot_s", plausibility.LOCKED_ROTOR_S, unit="s"),
        acceleration_factor=table.number("acceleration_factor", ACCELERATION_FACTOR, default=1.0),
        running_time_constant_s=table.optional_number("running_time_constant_s", TIME_CONSTANT_S, unit="s"),
        standstill_time_constant_s=table.optional_number(
            "standstill_time_constant_s", TIME_CONSTANT_S, unit="s"
        ),
        full_load_current_A=table.optional_number(
            "full_load_current_A", (least * base_A, most * base_A), unit="A"
        ),
    )
