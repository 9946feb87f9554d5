"""A recording made of a table: which column measures what, in SI units, at which rate and time.

What a motor's file or the command line says of a column counts first, then its name and unit. A column of a
clear name without a unit is taken as amperes or volts, and says so: whether that can be is judged against the
nameplate.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from core.recordings.channel_roles import ChannelRole, channel_roles
from core.recordings.errors import RecordingError, quoted
from core.recordings.length import check_length
from core.recordings.tables.dates import date_in_name
from core.recordings.tables.reading import read_table
from core.recordings.tables.table import Column, Table
from core.recordings.waveform import Channel, Quantity, Recording
from core.table_layout import ANY_LAYOUT, TableLayout, TableScaling

SAME_RATE = 0.01
"""A rate that is given may differ from that of the file by so much, relatively."""
PHASES = {"a": 0, "b": 1, "c": 2, "ab": 0, "bc": 1, "ca": 2}
UNITS = {Quantity.CURRENT: "A", Quantity.PHASE_VOLTAGE: "V", Quantity.LINE_VOLTAGE: "V"}
PLACE = "[tables] of the motor's file"


def read_table_recording(
    path: Path, layout: TableLayout = ANY_LAYOUT, most_values: int | None = None
) -> Recording:
    """Read a table as a recording.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    layout : TableLayout, optional
        What is known of its columns.
    most_values : int or None, optional
        Refuse a longer one.

    Returns
    -------
    Recording
        The recording. It has no start time where neither the file nor its name tells one.

    Raises
    ------
    RecordingError
        If the file cannot be read, a column is of another unit than it is said to be, or no rate is known.
    OSError
        If the file cannot be read.
    """
    table = read_table(path)
    check_length(path, len(table.columns), table.columns[0].values.size, most_values)
    rate_hz = _rate_hz(path, table, layout.scaling.sample_rate_hz)
    channels, samples = [], np.empty((len(table.columns), table.columns[0].values.size))
    roles = _roles(table, layout)
    for row, (column, (role, assumed)) in enumerate(zip(table.columns, roles, strict=True)):
        channel, values = _channel(path, column, role, layout.scaling, assumed=assumed)
        channels.append(channel)
        samples[row] = values
    start_ns, notes = table.start_time_ns, table.notes
    if start_ns is None and (start_ns := date_in_name(path.name)) is not None:
        notes = (*notes, "the time is that of the file's name, taken as UTC")
    return Recording(
        samples=samples,
        sample_rate_hz=rate_hz,
        start_time_ns=start_ns,
        channels=tuple(channels),
        instants_s=table.instants_s,
        warnings=(*notes, *_assumed(channels)),
        source=str(path),
    )


def _rate_hz(path: Path, table: Table, given_hz: float | None) -> float:
    told_hz = table.sample_rate_hz
    if told_hz is None and given_hz is None:
        raise RecordingError(
            path,
            "sampling rate",
            expected=f"a column of times, or sample_rate_Hz in {PLACE} (--rate of the command)",
            found="neither"
            if table.numbered_by is None
            else f"only the number of the row ({table.numbered_by!r})",
        )
    if told_hz is not None and given_hz is not None and abs(given_hz / told_hz - 1.0) > SAME_RATE:
        expected = f"the rate of the file's times, {told_hz:g} Hz"
        raise RecordingError(path, "sample_rate_Hz (--rate)", expected=expected, found=f"{given_hz:g} Hz")
    return told_hz or given_hz or 0.0


def _roles(table: Table, layout: TableLayout) -> list[tuple[ChannelRole, bool]]:
    """Return the role of each column, and whether its unit was assumed."""
    named = {column: key for key, column in layout.columns}
    told = channel_roles([(c.name, "", c.unit) for c in table.columns])
    as_amperes = channel_roles([(c.name, "", c.unit or "A") for c in table.columns])
    as_volts = channel_roles([(c.name, "", c.unit or "V") for c in table.columns])
    roles = []
    for column, *by_unit in zip(table.columns, told, as_amperes, as_volts, strict=True):
        key = named.get(column.name)
        if key is not None:
            roles.append(_named_role(column, key, by_unit[0]))
        elif column.unit:
            roles.append((by_unit[0], False))
        else:
            clear = [role for role in by_unit[1:] if role.phase is not None]
            roles.append((clear[0], True) if len(clear) == 1 else (by_unit[0], False))
    return roles


def _named_role(column: Column, key: str, by_unit: ChannelRole) -> tuple[ChannelRole, bool]:
    phase = key[1:]
    voltage = Quantity.LINE_VOLTAGE if len(phase) == 2 else Quantity.PHASE_VOLTAGE
    quantity = Quantity.CURRENT if key[0] == "i" else voltage
    unit = by_unit.unit if column.unit else UNITS[quantity]
    return replace(by_unit, quantity=quantity, phase=phase, unit=unit), not column.unit


def _channel(
    path: Path, column: Column, role: ChannelRole, scaling: TableScaling, *, assumed: bool
) -> tuple[Channel, NDArray[np.float64]]:
    """Return the channel of a column, and its samples in SI."""
    unit = UNITS.get(role.quantity)
    is_current = role.quantity is Quantity.CURRENT
    scales = scaling.current_scale if is_current else scaling.voltage_scale
    offsets = scaling.current_offset if is_current else scaling.voltage_offset
    if unit is None:
        return Channel(column.name, role.quantity, role.phase, role.unit), column.values * role.scale
    place = PHASES.get(role.phase or "", 0)
    with np.errstate(over="ignore", invalid="ignore"):
        if scales is not None:
            values = column.values * scales[place] + offsets[place]
            return Channel(column.name, role.quantity, role.phase, unit), values
        if role.unit != unit:
            key = "current_scale" if is_current else "voltage_scale"
            raise RecordingError(
                path,
                f"column {quoted(column.name)}",
                expected=f"{unit}, or {key} in {PLACE} (--{key.replace('_', '-')})",
                found=f"unit {quoted(column.unit)}",
            )
        values = column.values * role.scale + offsets[place]
    return Channel(column.name, role.quantity, role.phase, unit, unit_is_assumed=assumed), values


def _assumed(channels: list[Channel]) -> tuple[str, ...]:
    names = [f"{quoted(one.name)} [{one.unit}]" for one in channels if one.unit_is_assumed]
    return (f"columns without a unit are taken as amperes and volts: {', '.join(names)}",) if names else ()
