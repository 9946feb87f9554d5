"""Which column of a table has the times, in which unit, and what sampling rate they give."""

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from core.recordings.errors import RecordingError, quoted
from core.recordings.tables.table import FEWEST_SAMPLES, Column, Table
from core.units import NANOSECONDS_PER_SECOND

UNEVEN = 0.5
"""Farthest that a column of times may be from even steps, in steps: they are written with few digits."""
EPOCH_S = (1e8, 1e11)
"""Seconds since 1970 are between these (1973 to 5138); milliseconds are 1000 times as many."""

SECONDS_BY_UNIT = {
    "s": 1.0, "sec": 1.0, "secs": 1.0, "second": 1.0, "seconds": 1.0, "sek": 1.0,
    "ms": 1e-3, "msec": 1e-3, "millisecond": 1e-3, "milliseconds": 1e-3,
    "us": 1e-6, "µs": 1e-6, "μs": 1e-6, "usec": 1e-6, "microsecond": 1e-6, "microseconds": 1e-6,
    "ns": 1e-9, "nsec": 1e-9, "nanosecond": 1e-9, "nanoseconds": 1e-9,
    "min": 60.0, "minute": 60.0, "minutes": 60.0,
}  # fmt: skip
_TIME = re.compile(
    r"(?i:rel(ative)?|abs(olute)?|elapsed|sample|sampling)?[ _-]?"
    r"(?i:time ?stamps?|times?|zeit(stempel)?|temps|tiempo|tempo|datetime|x[-_ ]?axis|x[-_ ]?value|t|"
    r"seconds?|secs?|milliseconds?|microseconds?)"
    r"([ _/-]*(?:in )?[\[(]?(?P<unit>[A-Za-zµμ]+)[\])]?)?"
)
_NUMBER = re.compile(
    r"|n|nr|no|num|#|idx|index|row|points?|count(er)?|sequence|x|unnamed: ?0|__index_level_0__|"
    r"samples?|samples?[ _-]?(#|no|nr|num|number|index|id)\.?",
    re.IGNORECASE,
)


def table_of(
    path: Path,
    columns: Sequence[Column],
    *,
    sample_rate_hz: float | None = None,
    start_time_ns: int | None = None,
    notes: tuple[str, ...] = (),
) -> Table:
    """Take the times out of the columns of a file.

    Times are a column of dates, one whose name or unit says so, or the first one if it has no name and grows
    evenly. A column that only numbers the rows is left out.

    Parameters
    ----------
    path : pathlib.Path
        The file, for messages.
    columns : sequence of Column
        All columns.
    sample_rate_hz : float or None, optional
        Sampling rate by the head of the file [Hz], where no column has the times.
    start_time_ns : int or None, optional
        UTC of the first row by the head of the file [ns since 1970].
    notes : tuple of str, optional
        What was left out so far.

    Returns
    -------
    Table
        The table.

    Raises
    ------
    RecordingError
        If there are too few rows or columns, or the times go back.
    """
    rows = columns[0].values.size if columns else 0
    if rows < FEWEST_SAMPLES:
        expected = f"{FEWEST_SAMPLES} rows of numbers and more"
        raise RecordingError(path, "samples", expected=expected, found=str(rows))
    rest = list(columns)
    numbered_by = None
    place = _place_of_numbers(rest)
    if place is not None and len(rest) > 1:
        numbered_by = rest.pop(place).name
    place = _place_of_times(rest) if len(rest) > 1 else None
    if place is None:
        return Table(tuple(rest), sample_rate_hz, None, start_time_ns, numbered_by, notes)
    times = rest.pop(place)
    scale = 1.0 if times.dates_ns is not None else _unit_s(times)
    start_ns, seconds = _seconds(times, scale)
    rate_hz, instants_s = _rate(path, times.name, seconds)
    start_time_ns = start_time_ns if start_ns is None else start_ns
    return Table(tuple(rest), rate_hz, instants_s, start_time_ns, numbered_by, notes)


def is_time_unit(unit: str) -> bool:
    """Tell whether a unit is one of times.

    Parameters
    ----------
    unit : str
        The unit as it is written, without brackets.

    Returns
    -------
    bool
        Whether it is.
    """
    return unit.strip().casefold() in SECONDS_BY_UNIT


def _place_of_numbers(columns: Sequence[Column]) -> int | None:
    """Return the column that counts the rows one by one and is called so; None where there is none."""
    for place, column in enumerate(columns):
        unnamed = column.name == str(place + 1)
        is_first = place == 0 and unnamed
        says_so = is_first or (not unnamed and _NUMBER.fullmatch(column.name.strip()))
        if says_so and not column.unit and not column.is_time and _counts(column.values):
            return place
    return None


def _counts(x: NDArray[np.float64]) -> bool:
    return bool(float(x[0]).is_integer() and (np.diff(x) == 1.0).all())


def _place_of_times(columns: Sequence[Column]) -> int | None:
    for place, column in enumerate(columns):
        if column.dates_ns is not None or column.is_time or is_time_unit(column.unit):
            return place
    for place, column in enumerate(columns):
        named = _TIME.fullmatch(_own_name(column))
        if not named or column.unit or not (named["unit"] is None or is_time_unit(named["unit"])):
            continue
        if len(_own_name(column)) > 1 or _grows_evenly(column.values):  # T may be a temperature
            return place
    first = columns[0]
    says_nothing = not first.unit and not re.search(r"[^\W\d_]", first.name)
    return 0 if says_nothing and _grows_evenly(first.values) else None


def _own_name(column: Column) -> str:
    """Return the name without those of the groups or structures that it is in."""
    return re.split(r"[./](?=[A-Za-z])(?!.*[\[(])", column.name.strip())[-1]


def _grows_evenly(x: NDArray[np.float64]) -> bool:
    step = _step(x)
    even = x[0] + step * np.arange(x.size)
    return step > 0.0 and bool((np.abs(x - even) <= UNEVEN * step).all())


def _step(x: NDArray[np.float64]) -> float:
    with np.errstate(over="ignore", invalid="ignore"):
        return float((x[-1] - x[0]) / (x.size - 1))


def _unit_s(times: Column) -> float:
    """Return the unit of a column of times [s]: as the file says it, else by size, else seconds."""
    named = _TIME.fullmatch(_own_name(times))
    unit = times.unit or (named["unit"] if named else None) or ""
    if unit.strip().casefold() in SECONDS_BY_UNIT:
        return SECONDS_BY_UNIT[unit.strip().casefold()]
    first = float(times.values[0])
    for part in (1.0, 1e-3, 1e-6, 1e-9):
        if EPOCH_S[0] <= first * part < EPOCH_S[1]:
            return part
    return 1.0


def _seconds(times: Column, scale: float) -> tuple[int | None, NDArray[np.float64]]:
    """Return UTC of the first row, where the times have it, and the seconds after the first."""
    first = float(times.values[0])
    with np.errstate(over="ignore", invalid="ignore"):
        seconds = (times.values - first) * scale
    if times.dates_ns is not None:
        return times.dates_ns, seconds
    is_epoch = EPOCH_S[0] <= first * scale < EPOCH_S[1]
    return (round(first * scale * NANOSECONDS_PER_SECOND) if is_epoch else None), seconds


def _rate(path: Path, name: str, seconds: NDArray[np.float64]) -> tuple[float, NDArray[np.float64] | None]:
    """Return the sampling rate, and the times themselves where they are not even."""
    field = f"column of times {quoted(name)}"
    steps = np.diff(seconds)
    if not np.isfinite(seconds).all():
        row = int(np.argmin(np.isfinite(seconds))) + 1
        raise RecordingError(path, field, expected="a time in every row", found=f"none in row {row}")
    if not seconds[-1] > 0.0 or float(steps.min()) < 0.0:
        row = int(np.argmin(steps)) + 2
        raise RecordingError(path, field, expected="times that grow", found=f"a step back in row {row}")
    step = _step(seconds)
    off = float(np.abs(seconds - step * np.arange(seconds.size)).max())
    # Times in coarse units repeat: the rows between two of them are evenly spread.
    coarse = float(steps.max()) if float(steps.min()) == 0.0 else 0.0
    if off <= max(UNEVEN * step, coarse):
        return 1.0 / step, None
    if coarse:
        row = int(np.argmin(steps)) + 2
        found = f"the same time twice, in row {row}, and gaps"
        raise RecordingError(path, field, expected="times that grow", found=found)
    return 1.0 / float(np.median(steps)), seconds


def renamed(columns: Sequence[Column]) -> tuple[Column, ...]:
    """Give columns of one name numbers behind it, so that each can be chosen.

    Parameters
    ----------
    columns : sequence of Column
        The columns.

    Returns
    -------
    tuple of Column
        Columns of different names.
    """
    names = [column.name for column in columns]
    seen: dict[str, int] = {}
    told = []
    for column in columns:
        if names.count(column.name) > 1:
            seen[column.name] = seen.get(column.name, 0) + 1
            column = replace(column, name=f"{column.name}[{seen[column.name]}]")
        told.append(column)
    return tuple(told)
