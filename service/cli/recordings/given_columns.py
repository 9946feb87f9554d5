"""What a command line says of a table's columns, in place of the motor's file."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from core.machines.parameters import Motor
from core.table_layout import PhaseFactors
from service.cli.output import WRONG_USE, CommandError

SETS = (("ia", "ib", "ic"), ("va", "vb", "vc"), ("vab", "vbc", "vca"))
"""Quantities that are given together: currents, phase voltages, line voltages."""


@dataclass(frozen=True, slots=True)
class GivenColumns:
    """Columns (QUANTITY=NAME), sampling rate [Hz], and scale and offset; None for what is not given."""

    columns: Sequence[str] = ()
    sample_rate_hz: float | None = None
    current_scale: float | None = None
    current_offset: float | None = None
    voltage_scale: float | None = None
    voltage_offset: float | None = None


NOTHING_GIVEN = GivenColumns()


def with_given_columns(motor: Motor, given: GivenColumns) -> Motor:
    """Return the motor with what is given. Raises CommandError (wrong use)."""
    names = _names(given.columns)
    currents, phase_voltages, line_voltages = (_set(keys, names) for keys in SETS)
    channels = motor.channels
    if names:
        channels = replace(
            channels,
            currents=currents or channels.currents,
            phase_voltages=phase_voltages or (None if line_voltages else channels.phase_voltages),
            line_voltages=line_voltages or (None if phase_voltages else channels.line_voltages),
        )
    tables = motor.tables
    tables = replace(
        tables,
        sample_rate_hz=given.sample_rate_hz or tables.sample_rate_hz,
        current_scale=_of_all(given.current_scale) or tables.current_scale,
        current_offset=_of_all(given.current_offset) or tables.current_offset,
        voltage_scale=_of_all(given.voltage_scale) or tables.voltage_scale,
        voltage_offset=_of_all(given.voltage_offset) or tables.voltage_offset,
    )
    return replace(motor, channels=channels, tables=tables)


def _names(columns: Sequence[str]) -> dict[str, str]:
    known = [key for keys in SETS for key in keys]
    names = {}
    for one in columns:
        key, _, name = one.partition("=")
        if key not in known or not name:
            raise _wrong(f"expected QUANTITY=NAME with a quantity of {', '.join(known)}, found {one!r}")
        names[key] = name
    return names


def _set(keys: tuple[str, str, str], names: dict[str, str]) -> tuple[str, str, str] | None:
    given = [key for key in keys if key in names]
    if not given:
        return None
    if len(given) < len(keys):
        raise _wrong(f"expected columns of {', '.join(keys)} together, found {', '.join(given)}")
    first, second, third = (names[key] for key in keys)
    return first, second, third


def _of_all(number: float | None) -> PhaseFactors | None:
    return None if number is None else (number, number, number)


def _wrong(message: str) -> CommandError:
    return CommandError(f"--column: {message}", exit_code=WRONG_USE)
