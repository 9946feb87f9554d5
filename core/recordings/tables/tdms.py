"""Tables in the TDMS files of LabVIEW and its loggers, by nptdms."""

from pathlib import Path
from typing import Any

import numpy as np

from core.recordings.errors import RecordingError
from core.recordings.tables.library import library, refusing_damage
from core.recordings.tables.table import Column, Table
from core.recordings.tables.time_column import renamed, table_of
from core.units import NANOSECONDS_PER_SECOND

UNITS = ("unit_string", "NI_UnitDescription", "unit", "Unit")


def read_tdms_table(path: Path) -> Table:
    """Read a table from a TDMS file: the longest channels of numbers, which must have one rate.

    A channel is named by its own name where no other group has it, else group/channel.

    Parameters
    ----------
    path : pathlib.Path
        The file.

    Returns
    -------
    Table
        The table.

    Raises
    ------
    RecordingError
        If the file is damaged, has no channels of numbers, or several rates, or nptdms is not installed.
    """
    nptdms = library(path, "nptdms", "TDMS files")
    with refusing_damage(path, "a TDMS file"):
        file = nptdms.TdmsFile.read(path)
        channels = [channel for group in file.groups() for channel in group.channels()]
        numbered = [channel for channel in channels if channel.dtype.kind in "fiuM" and len(channel) > 1]
        longest = max((len(channel) for channel in numbered), default=0)
        kept = [channel for channel in numbered if len(channel) == longest]
        names = [channel.name for channel in kept]
        columns = [_column(channel, names) for channel in kept]
        steps_s = {_increment_s(channel) for channel in kept} - {0.0}
        left_out = [f"{one.group_name}/{one.name}" for one in channels if one not in kept and len(one)]
        start_ns = next((ns for ns in map(_start_ns, kept) if ns is not None), None)
    if len(steps_s) > 1:
        found = ", ".join(f"{step:g} s" for step in sorted(steps_s))
        raise RecordingError(path, "wf_increment", expected="one sampling interval", found=found)
    step_s = max(steps_s, default=0.0)
    notes = (f"left out beside {longest} values: {', '.join(left_out[:12])}",) if left_out else ()
    rate_hz = 1.0 / step_s if step_s > 0.0 else None
    return table_of(path, renamed(columns), sample_rate_hz=rate_hz, start_time_ns=start_ns, notes=notes)


def _column(channel: Any, names: list[str]) -> Column:
    name = channel.name if names.count(channel.name) == 1 else f"{channel.group_name}/{channel.name}"
    values = channel[:]
    if values.dtype.kind == "M":
        instants = values.astype("datetime64[ns]")
        seconds = (instants - instants[0]).astype(np.float64) / NANOSECONDS_PER_SECOND
        return Column(name, "", seconds, int(instants[0].astype(np.int64)), is_time=True)
    unit = next((str(channel.properties[key]) for key in UNITS if key in channel.properties), "")
    return Column(name, unit, values.astype(np.float64))


def _increment_s(channel: Any) -> float:
    return float(channel.properties.get("wf_increment", 0.0))


def _start_ns(channel: Any) -> int | None:
    start = channel.properties.get("wf_start_time")
    return None if start is None else int(np.datetime64(start, "ns").astype(np.int64))
