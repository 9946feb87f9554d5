"""What a motor's file says of its feeder: capacitors, cable, place of the transformers, neutral."""

from collections.abc import Mapping
from pathlib import Path

from core.machines.motor_file.error import MotorFileError
from core.machines.motor_file.table import MotorTable
from core.machines.parameters import (
    Cable,
    Capacitors,
    Connection,
    CurrentPosition,
    Motor,
    Nameplate,
    Transformers,
)

KEYS = ("ct_position", "neutral")
"""Keys of the file beside its tables."""
MOST_KVAR = 2.0
"""Largest bank, in rated powers of the motor."""
LARGEST_DROP = 0.3
"""Largest resistance and reactance of a cable, over V^2 / P."""


def capacitors(table: MotorTable, nameplate: Nameplate) -> Capacitors | None:
    """Read the table [capacitors].

    Parameters
    ----------
    table : MotorTable
        The table.
    nameplate : Nameplate
        Rated values of the motor.

    Returns
    -------
    Capacitors or None
        The bank; None where the file has none.
    """
    if table.is_empty:
        return None
    power_kW = nameplate.rated_power_W / 1e3
    kvar = table.number("kvar", (0.001 * power_kW, MOST_KVAR * power_kW), unit="kvar")
    return Capacitors(kvar, table.word("connection", Connection.DELTA))


def cable(table: MotorTable, nameplate: Nameplate) -> Cable | None:
    """Read the table [cable].

    Parameters
    ----------
    table : MotorTable
        The table.
    nameplate : Nameplate
        Rated values of the motor.

    Returns
    -------
    Cable or None
        The cable; None where the file has none.
    """
    if table.is_empty:
        return None
    most = LARGEST_DROP * nameplate.rated_voltage_V**2 / nameplate.rated_power_W
    resistance, _ = table.span("resistance_ohm", most, "ohm")
    reactance, _ = table.span("reactance_ohm", most, "ohm")
    return Cable(resistance, reactance)


def transformers(
    table: MotorTable,
    keys: Mapping[str, object],
    connection: Connection,
    source: Path | str,
    errors: list[MotorFileError],
) -> Transformers:
    """Read the table [transformers], and the file's key ct_position, which is its current_position.

    Parameters
    ----------
    table : MotorTable
        The table.
    keys : mapping of str to object
        The whole file.
    connection : Connection
        Star or delta.
    source : pathlib.Path or str
        Where the file comes from, for messages.
    errors : list of MotorFileError
        Gets the errors.

    Returns
    -------
    Transformers
        The transformers.
    """
    position = table.word("current_position", CurrentPosition.LINE)
    field = "[transformers] current_position"
    given = keys.get("ct_position")
    if given is not None:
        known = [each.value for each in CurrentPosition]
        if given not in known:
            expected = " or ".join(f'"{each}"' for each in known)
            errors.append(MotorFileError(source, "ct_position", expected=expected, found=repr(given)))
        elif position not in {CurrentPosition.LINE, given}:
            errors.append(
                MotorFileError(source, "ct_position", expected=f'"{position}", as {field}', found=repr(given))
            )
        else:
            position, field = CurrentPosition(str(given)), "ct_position"
    if position is CurrentPosition.INSIDE_DELTA and connection is Connection.STAR:
        expected = f'"{CurrentPosition.LINE}" or "{CurrentPosition.BEFORE_CAPACITORS}" for a motor in star'
        errors.append(MotorFileError(source, field, expected=expected, found=f'"{position}"'))
    return Transformers(table.ratio("voltage_ratio"), table.ratio("current_ratio"), position)


def neutral(
    keys: Mapping[str, object], connection: Connection, source: Path | str, errors: list[MotorFileError]
) -> bool:
    """Read the file's key neutral.

    Parameters
    ----------
    keys : mapping of str to object
        The whole file.
    connection : Connection
        Star or delta.
    source : pathlib.Path or str
        Where the file comes from, for messages.
    errors : list of MotorFileError
        Gets the errors.

    Returns
    -------
    bool
        Whether the star point is on the neutral.
    """
    given = keys.get("neutral", False)
    if not isinstance(given, bool):
        errors.append(MotorFileError(source, "neutral", expected="true or false", found=repr(given)))
        return False
    if given and connection is Connection.DELTA:
        expected = "false for a motor in delta, which has no star point"
        errors.append(MotorFileError(source, "neutral", expected=expected, found="true"))
    return given


def feeder_lines(motor: Motor) -> list[str]:
    """Return the tables of a motor's file that tell of its feeder.

    Parameters
    ----------
    motor : Motor
        The motor.

    Returns
    -------
    list of str
        The lines, none where there is nothing to tell.
    """
    lines: list[str] = []
    if motor.capacitors is not None:
        bank = motor.capacitors
        lines += ["", "[capacitors]", f"kvar = {bank.kvar:.7g}", f'connection = "{bank.connection}"']
    if motor.cable is not None:
        lines += ["", "[cable]", f"resistance_ohm = {motor.cable.resistance_ohm:.7g}"]
        lines.append(f"reactance_ohm = {motor.cable.reactance_ohm:.7g}")
    return lines
