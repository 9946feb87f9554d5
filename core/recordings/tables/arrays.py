"""Arrays by their names, as MATLAB and NumPy files have them, made columns of one table."""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from core.recordings.errors import RecordingError
from core.recordings.tables.table import FEWEST_SAMPLES, Column, Table
from core.recordings.tables.time_column import renamed, table_of

MOST_COLUMNS = 1_000
_RATE = re.compile(
    r"(.*[._/])?(fs|f_s|fsample|sampl(e|ing)_?(rate|frequency|freq)|rate)(_?hz)?", re.IGNORECASE
)
_STEP = re.compile(
    r"(.*[._/])?(dt|ts|t_s|delta_?t|tsample|sampl(e|ing)_?(time|period|interval))(_?s)?", re.IGNORECASE
)


def table_of_arrays(
    path: Path, arrays: Mapping[str, NDArray[np.generic]], units: Mapping[str, str] | None = None
) -> Table:
    """Make a table of the longest arrays of a file; one of numbers may tell the sampling rate or interval.

    An array of two dimensions is as many columns as its shorter side is long: name[1], name[2], ...

    Parameters
    ----------
    path : pathlib.Path
        The file, for messages.
    arrays : mapping of str to ndarray
        Arrays by their names.
    units : mapping of str to str, optional
        Units by the same names.

    Returns
    -------
    Table
        The table.

    Raises
    ------
    RecordingError
        If no array has real numbers, or there are too many.
    """
    columns: list[Column] = []
    rate_hz: float | None = None
    left_out: list[str] = []
    for name, array in arrays.items():
        if not (np.issubdtype(array.dtype, np.floating) or np.issubdtype(array.dtype, np.integer)):
            if array.size >= FEWEST_SAMPLES:
                left_out.append(f"{name} ({array.dtype}, no real numbers)")
            continue
        if array.size == 1:
            rate_hz = rate_hz or _rate_hz(name, float(array.reshape(-1)[0]))
            continue
        columns += _columns(name, array, (units or {}).get(name, ""))
    longest = max((column.values.size for column in columns), default=0)
    left_out += [f"{c.name} ({c.values.size} values)" for c in columns if c.values.size != longest]
    kept = [column for column in columns if column.values.size == longest]
    if longest < FEWEST_SAMPLES or len(kept) > MOST_COLUMNS:
        expected = f"arrays of {FEWEST_SAMPLES} numbers and more, {MOST_COLUMNS} at most"
        found = ", ".join(arrays)[:200] or "none"
        raise RecordingError(path, "arrays", expected=expected, found=found)
    notes = (f"left out beside arrays of {longest} values: {', '.join(left_out[:12])}",) if left_out else ()
    return table_of(path, renamed(kept), sample_rate_hz=rate_hz, notes=notes)


def _rate_hz(name: str, value: float) -> float | None:
    if not 0.0 < value < np.inf:
        return None
    if _RATE.fullmatch(name):
        return value
    return 1.0 / value if _STEP.fullmatch(name) else None


def _columns(name: str, array: NDArray[np.generic], unit: str) -> Iterable[Column]:
    """Yield the columns of an array; those of more than two dimensions have none."""
    squeezed = np.squeeze(array)
    if squeezed.ndim == 1:
        yield Column(name, unit, squeezed.astype(np.float64))
    elif squeezed.ndim == 2:
        rows = squeezed if squeezed.shape[0] >= squeezed.shape[1] else squeezed.T
        for number in range(min(rows.shape[1], MOST_COLUMNS + 1)):
            yield Column(f"{name}[{number + 1}]", unit, rows[:, number].astype(np.float64))
