"""Dates and times of day as relays write them, in the zone of the relay's clock, which no report tells."""

import re
from datetime import UTC, datetime
from enum import StrEnum

from core.relay_reports.report_text import Line
from core.units import NANOSECONDS_PER_MILLISECOND, NANOSECONDS_PER_SECOND

_DATE = re.compile(r"(\d{1,4})[/-](\d{1,2})[/-](\d{1,4})", re.ASCII)
_TIME = re.compile(r"(\d{1,2}):(\d\d):(\d\d)(?:\.(\d{1,6}))?", re.ASCII)
_CLOCK = re.compile(r".*\bDate:\s*(\S+)\s+Time:\s*(\S+)", re.IGNORECASE)
_CENTURY = 2000
_YEARS = range(1970, 2200)
"""No relay kept a report before; later ones are no times in nanoseconds."""


class DateOrder(StrEnum):
    """Order of year, month and day: the relay's setting DATE_F."""

    MDY = "MDY"
    YMD = "YMD"
    DMY = "DMY"


def time_of(line: Line, date: str, time_of_day: str, order: DateOrder) -> int:
    """Return a date and a time of day.

    Parameters
    ----------
    line : Line
        The line they are in.
    date, time_of_day : str
        The two fields; a year of two digits is one of this century.
    order : DateOrder
        Order of the date.

    Returns
    -------
    int
        The time of the relay's clock, as if this were in UTC [ns].

    Raises
    ------
    ReportError
        If they are no date and time.
    """
    days = _DATE.fullmatch(date)
    if days is None:
        raise line.error("date", expected=f"a date in the order {order}", found=date)
    given = dict(zip(order.value, map(int, days.groups()), strict=True))
    clock = _TIME.fullmatch(time_of_day)
    if clock is None:
        raise line.error("time", expected="a time such as 13:05:07.250", found=time_of_day)
    year = given["Y"] if given["Y"] >= 100 else _CENTURY + given["Y"]
    nanoseconds = int((clock[4] or "0").ljust(9, "0"))
    return (
        _time(line, (year, given["M"], given["D"]), (int(clock[1]), int(clock[2]), int(clock[3])))
        + nanoseconds
    )


def clock_in(line: Line, order: DateOrder) -> int | None:
    """Return the relay's clock where a line of a heading has it.

    Parameters
    ----------
    line : Line
        The line.
    order : DateOrder
        Order of the date.

    Returns
    -------
    int or None
        When the report was made, by the relay's clock, as if this were in UTC [ns]; None where the line has
        no clock.

    Raises
    ------
    ReportError
        If what stands in the clock's place is no date and time.
    """
    found = _CLOCK.fullmatch(line.text)
    return None if found is None else time_of(line, found[1], found[2], order)


def time_of_fields(line: Line, fields: dict[str, str]) -> int:
    """Return the time in the fields MONTH to MSEC of a Compressed ASCII line.

    Parameters
    ----------
    line : Line
        The line.
    fields : dict of str to str
        Its fields by label.

    Returns
    -------
    int
        The time of the relay's clock, as if this were in UTC [ns].

    Raises
    ------
    ReportError
        If one is missing, or they are no date and time.
    """
    numbers = []
    for label in ("YEAR", "MONTH", "DAY", "HOUR", "MIN", "SEC", "MSEC"):
        text = fields.get(label, "")
        if not re.fullmatch(r"\d{1,4}", text, re.ASCII):
            raise line.error(label, expected="a whole number", found=text)
        numbers.append(int(text))
    year, month, day, hour, minute, second, millisecond = numbers
    if millisecond >= 1000:
        raise line.error("MSEC", expected="0 to 999", found=str(millisecond))
    return _time(line, (year, month, day), (hour, minute, second)) + millisecond * NANOSECONDS_PER_MILLISECOND


def _time(line: Line, date: tuple[int, int, int], clock: tuple[int, int, int]) -> int:
    if date[0] not in _YEARS:
        expected = f"a year from {_YEARS.start} to {_YEARS.stop - 1}"
        raise line.error("time", expected=expected, found=str(date[0]))
    try:
        moment = datetime(*date, *clock, tzinfo=UTC)
    except ValueError as error:
        found = "-".join(map(str, date)) + " " + ":".join(map(str, clock))
        raise line.error("time", expected=f"a date and time that exist ({error})", found=found) from error
    return round(moment.timestamp()) * NANOSECONDS_PER_SECOND
