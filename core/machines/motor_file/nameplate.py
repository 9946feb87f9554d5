"""The plate of a motor, and of its rotor where that is wound, as [nameplate] and [rotor_circuit] say them."""

from dataclasses import replace
from math import isnan, sqrt

from core.machines import plausibility
from core.machines.motor_file.table import MotorTable
from core.machines.parameters import Connection, MachineKind, Nameplate, WoundRotor
from core.quantity_text import plain

OF_A_WOUND_ROTOR = ("rotor_voltage_V", "rotor_current_A")
"""Keys of the nameplate that a cage does not have."""
BELONGS_TO_A_WOUND_ROTOR = 'nothing, or kind = "wound-rotor" under [nameplate]'


def read_nameplate(table: MotorTable) -> Nameplate:
    """Read the rated values of a motor.

    Parameters
    ----------
    table : MotorTable
        The table [nameplate].

    Returns
    -------
    Nameplate
        Its rated values.
    """
    voltage_V = table.number("rated_voltage_V", plausibility.RATED_VOLTAGE_V, unit="V")
    if isnan(voltage_V):
        power_W = table.number("rated_power_W", plausibility.RATED_POWER_W, unit="W")
    else:
        power = plausibility.plausible_power(voltage_V)
        power_W = table.number("rated_power_W", (power.least, power.most), str(power))
    nameplate = Nameplate(
        rated_power_W=power_W,
        rated_voltage_V=voltage_V,
        rated_frequency_Hz=table.number("rated_frequency_Hz", plausibility.RATED_FREQUENCY_HZ, unit="Hz"),
        pole_pairs=table.count("pole_pairs", plausibility.MOST_POLE_PAIRS),
        connection=table.word("connection", Connection.STAR),
        rotor_bars=_rotor_bars(table),
    )
    slowest, fastest = (share * nameplate.synchronous_rpm for share in plausibility.RATED_SPEED)
    speed_rpm = table.optional_number("rated_speed_rpm", (slowest, fastest), unit="rpm")
    return replace(nameplate, rated_speed_rpm=speed_rpm)


def _rotor_bars(table: MotorTable) -> int | None:
    """Return the number of bars; files from before they were looked for call them rotor_slots."""
    bars = table.optional_count("rotor_bars", plausibility.MOST_ROTOR_BARS)
    slots = table.optional_count("rotor_slots", plausibility.MOST_ROTOR_BARS)
    return slots if bars is None else bars


def wound_rotor(plate: MotorTable, circuit: MotorTable, rated: Nameplate) -> WoundRotor | None:
    """Read the winding of a rotor.

    Parameters
    ----------
    plate : MotorTable
        The table [nameplate].
    circuit : MotorTable
        The table [rotor_circuit].
    rated : Nameplate
        Rated values of the motor.

    Returns
    -------
    WoundRotor or None
        The winding; None of a cage, to which none of its keys belongs.
    """
    if plate.word("kind", MachineKind.CAGE) is MachineKind.CAGE:
        plate.refuse_all(OF_A_WOUND_ROTOR, BELONGS_TO_A_WOUND_ROTOR)
        circuit.refuse_all(("external_resistance_ohm",), BELONGS_TO_A_WOUND_ROTOR)
        return None
    voltage_V = plate.number("rotor_voltage_V", plausibility.ROTOR_VOLTAGE_V, unit="V")
    least, most = plausibility.ROTOR_POWER
    base_A = rated.rated_power_W / (sqrt(3.0) * voltage_V)
    rotor = WoundRotor(
        open_circuit_voltage_V=voltage_V,
        rated_current_A=plate.number(
            "rotor_current_A",
            (least * base_A, most * base_A),
            f"{least:g} to {most:g} times rated_power_W / (sqrt(3) rotor_voltage_V) = {plain(base_A)} A",
        ),
    )
    most_ohm = plausibility.EXTERNAL_RESISTANCE * rotor.standstill_impedance_ohm
    return replace(
        rotor, external_resistance_ohm=circuit.span("external_resistance_ohm", most_ohm, "ohm a phase")
    )
