"""Dates and times of a COMTRADE configuration (5.3.7), and how far they are ahead of UTC (2013, 7.4.11)."""

import re
from dataclasses import dataclass
from datetime import UTC, datetime

from core.recordings.comtrade.lines import Line, Lines
from core.recordings.errors import RecordingError, quoted
from core.recordings.repairs import Repairs
from core.units import NANOSECONDS_PER_SECOND, SECONDS_PER_DAY

UNKNOWN = "the time is unknown"
"""What a lenient reader says of a date that the calendar does not have."""

_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_DATE = re.compile(r"([0-9]{1,2})/([0-9]{1,2})/([0-9]{4}|[0-9]{2})", re.ASCII)
_TIME = re.compile(r"([0-9]{1,2}):([0-9]{1,2}):([0-9]{1,2})(?:\.([0-9]{1,9}))?", re.ASCII)
_SPACED = re.compile(
    r" *([0-9]{1,2} */ *[0-9]{1,2} */ *[0-9]{2,4})"
    r"[ ,]+([0-9]{1,2} *: *[0-9]{1,2} *: *[0-9]{1,2}(?:\.[0-9]{1,9})?)[ ,]*",
    re.ASCII,
)
_FRACTION = re.compile(r"\.([0-9]{1,9})", re.ASCII)
_UTC_OFFSET = re.compile(r"([+-]?)([0-9]{1,2})(?:h([0-9]{1,2}))?", re.ASCII)


@dataclass(frozen=True, slots=True)
class Moment:
    """A date and time as written.

    Parameters
    ----------
    ns : int or None
        Nanoseconds since 1970 in the file's own time zone; None where a lenient reader could not tell.
    decimals : int
        Number of decimals of the seconds.
    """

    ns: int | None
    decimals: int


def date_time(line: Line, revision: int, repairs: Repairs) -> Moment:
    """Read a date and time.

    A lenient reader passes over spaces, and takes a date that the calendar does not have for unknown.

    Parameters
    ----------
    line : Line
        The line.
    revision : int
        Year of the edition: 1991 writes the month before the day.
    repairs : Repairs
        Collects what was mended; of a strict reader nothing is.

    Returns
    -------
    Moment
        The date and time.

    Raises
    ------
    RecordingError
        If the line holds no date and time between 1970 and 2200.
    """
    try:
        return _date_time(line, line.fields, revision)
    except RecordingError as fault:
        text = ",".join(line.fields)
        spaced = _SPACED.fullmatch(text)
        if spaced is not None:
            fields = tuple(part.replace(" ", "") for part in spaced.groups())
            try:
                moment = _date_time(line, fields, revision)
            except RecordingError:
                pass
            else:
                repairs.mend(fault, "read without its spaces")
                return moment
        repairs.mend(fault, UNKNOWN)
        fraction = _FRACTION.search(text)
        return Moment(None, len(fraction[1]) if fraction else 0)


def utc_offset_ns(lines: Lines, repairs: Repairs) -> int | None:
    """Read the two lines with which a file of 2013 ends: the time code and the quality of the time.

    A lenient reader takes the times for UTC where the lines are missing, and for unknown where the time code
    is none.

    Parameters
    ----------
    lines : Lines
        The lines of the file, up to these two.
    repairs : Repairs
        Collects what was mended; of a strict reader nothing is.

    Returns
    -------
    int or None
        How far the file's times are ahead of UTC [ns]; None where that is unknown.

    Raises
    ------
    RecordingError
        If the lines are missing or at fault.
    """
    offset: int | None = 0
    try:
        line = lines.next("time code and local code")
    except RecordingError as fault:
        repairs.mend(fault, "the times are taken as UTC")
        return 0
    try:
        offset = _utc_offset(line)
    except RecordingError as fault:
        repairs.mend(fault, "the times are unknown")
        offset = None
    try:
        _check_time_quality(lines.next("time quality and leap second"))
    except RecordingError as fault:
        repairs.mend(fault, "the quality of the time is not looked at")
    return offset


def _date_time(line: Line, fields: tuple[str, ...], revision: int) -> Moment:
    layout = "mm/dd/yy" if revision == 1991 else "dd/mm/yyyy"
    if len(fields) != 2:
        line.has_fields(2)
    date, time = _DATE.fullmatch(fields[0]), _TIME.fullmatch(fields[1])
    if date is None or time is None or (revision >= 1999 and len(date[3]) != 4):
        raise line.refuse("", f"{layout},hh:mm:ss.ssssss", line.quoted())
    day, month = (date[2], date[1]) if revision == 1991 else (date[1], date[2])
    year = int(date[3])
    if len(date[3]) == 2:  # two digits of a format born in 1991; its files reach into this century
        year += 1900 if year >= 70 else 2000
    if not 1970 <= year <= 2200:
        raise line.refuse("year", "1970 to 2200", str(year))
    try:
        moment = datetime(year, int(month), int(day), int(time[1]), int(time[2]), int(time[3]), tzinfo=UTC)
    except ValueError as error:
        raise line.refuse(
            "", f"a date and time, {layout},hh:mm:ss.ssssss", f"{line.quoted()} ({error})"
        ) from None
    elapsed = moment - _EPOCH
    fraction = time[4] or ""
    elapsed_s = elapsed.days * SECONDS_PER_DAY + elapsed.seconds
    return Moment(elapsed_s * NANOSECONDS_PER_SECOND + int(fraction.ljust(9, "0")), len(fraction))


def _utc_offset(line: Line) -> int:
    """Return how far the times are ahead of UTC [ns]; "-5h30" is 5.5 hours behind (2013, 7.4.11)."""
    line.has_fields(2)
    offset = _UTC_OFFSET.fullmatch(line.fields[0])
    if offset is None or int(offset[2]) > 14 or int(offset[3] or 0) > 59:
        raise line.refuse("time code", "hours ahead of UTC such as 0, +1 or -5h30", quoted(line.fields[0]))
    if line.fields[1] not in ("x", "X") and not _UTC_OFFSET.fullmatch(line.fields[1]):
        raise line.refuse(
            "local code", "hours ahead of UTC such as 0, +1 or -5h30, or x", quoted(line.fields[1])
        )
    minutes = int(offset[2]) * 60 + int(offset[3] or 0)
    return (-minutes if offset[1] == "-" else minutes) * 60 * NANOSECONDS_PER_SECOND


def _check_time_quality(line: Line) -> None:
    line.has_fields(2)
    if not re.fullmatch(r"[0-9A-Fa-f]", line.fields[0], re.ASCII):
        raise line.refuse("time quality", "a hexadecimal digit", quoted(line.fields[0]))
    line.integer(1, "leap second", 0, 3)
