"""Dates and times in cells of a table."""

import re
from collections.abc import Sequence
from datetime import UTC, datetime, timedelta, timezone

import numpy as np
from numpy.typing import NDArray

from core.units import NANOSECONDS_PER_DAY, NANOSECONDS_PER_SECOND

_DATE = re.compile(
    r"(?:(?P<year>\d{4})[-/.](?P<month>\d{1,2})[-/.](?P<day>\d{1,2})[T ]\s*|"
    r"(?P<first>\d{1,2})(?P<mark>[./])(?P<second>\d{1,2})[./](?P<late_year>\d{4})[T, ]\s*)?"
    r"(?P<hours>\d{1,2}):(?P<minutes>\d\d):(?P<seconds>\d\d)(?:[.,](?P<fraction>\d{1,9}))?\s*"
    r"(?P<zone>Z|UTC|[+-]\d\d:?\d\d)?"
)
_IN_NAME = re.compile(
    r"(\d{4})[-_]?(\d\d)[-_]?(\d\d)[-_T ]?(\d\d)[-_:]?(\d\d)[-_:]?(\d\d)(?!\d)", re.IGNORECASE
)


def is_date(cell: str) -> bool:
    """Tell whether a cell is a time of day, with a date or without.

    Parameters
    ----------
    cell : str
        The cell.

    Returns
    -------
    bool
        Whether it is.
    """
    return _DATE.fullmatch(cell) is not None


def instants(cells: Sequence[str]) -> tuple[int | None, NDArray[np.float64]]:
    """Read a column of dates and times.

    Parameters
    ----------
    cells : sequence of str
        Its cells.

    Returns
    -------
    first_ns : int or None
        UTC of the first [ns since 1970]; None where there is no date, or one that can be read in two ways.
    seconds : ndarray, shape (n,)
        Seconds after the first; NaN for a cell that is no time.
    """
    found = [_nanoseconds(cell) for cell in cells]
    first = found[0]
    if first is None:
        return None, np.full(len(cells), np.nan)
    start, has_date = first
    seconds = np.array(
        [np.nan if one is None else (one[0] - start) / NANOSECONDS_PER_SECOND for one in found]
    )
    if not has_date:  # past midnight
        seconds += (
            NANOSECONDS_PER_DAY
            / NANOSECONDS_PER_SECOND
            * np.cumsum(np.diff(seconds, prepend=0.0) < -43_200.0)
        )
    return (start if has_date else None), seconds


def date_in_name(name: str) -> int | None:
    """Read the date and time that a file is named after, such as mill_2026-01-31T12-00-00.csv.

    Parameters
    ----------
    name : str
        Name of the file.

    Returns
    -------
    int or None
        UTC [ns since 1970]; None where the name has none.
    """
    match = _IN_NAME.search(name)
    if match is None:
        return None
    year, month, day, hours, minutes, seconds = map(int, match.groups())
    try:
        named = datetime(year, month, day, hours, minutes, seconds, tzinfo=UTC)
    except ValueError:
        return None
    return round(named.timestamp()) * NANOSECONDS_PER_SECOND


def _nanoseconds(cell: str) -> tuple[int, bool] | None:
    """Return the instant [ns], and whether it has a date; None of what is no time."""
    match = _DATE.fullmatch(cell)
    if match is None:
        return None
    fraction_ns = int((match["fraction"] or "0").ljust(9, "0"))
    clock_ns = (int(match["hours"]) * 3600 + int(match["minutes"]) * 60 + int(match["seconds"])) * (
        NANOSECONDS_PER_SECOND
    )
    date = _date(match)
    if date is None:
        return clock_ns + fraction_ns, False
    try:
        midnight = datetime(*date, tzinfo=_zone(match["zone"]))
    except ValueError:
        return None
    return round(midnight.timestamp()) * NANOSECONDS_PER_SECOND + clock_ns + fraction_ns, True


def _date(match: re.Match[str]) -> tuple[int, int, int] | None:
    if match["year"]:
        return int(match["year"]), int(match["month"]), int(match["day"])
    if not match["late_year"]:
        return None
    first, second, year = int(match["first"]), int(match["second"]), int(match["late_year"])
    if match["mark"] == "." or first > 12:
        return year, second, first
    return (year, first, second) if second > 12 else None  # 3/4/2026 may be March or April


def _zone(text: str | None) -> timezone:
    if text is None or text in ("Z", "UTC"):
        return UTC
    ahead = timedelta(hours=int(text[1:3]), minutes=int(text[-2:]))
    return timezone(-ahead if text[0] == "-" else ahead)
