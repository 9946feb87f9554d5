"""Dates of a COMTRADE configuration (5.3.7): when the first sample was taken, and when the trigger came.

1991 writes mm/dd/yy, later editions dd/mm/yyyy. A date in another form is read, with a warning, where the
calendar leaves one way to read it: the two dates of a file are in the same order.
"""

import re
from dataclasses import dataclass
from datetime import UTC, datetime

from core.recordings.comtrade.lines import Line
from core.recordings.errors import RecordingError
from core.recordings.repairs import Repairs
from core.units import NANOSECONDS_PER_SECOND, SECONDS_PER_DAY

UNKNOWN = "the time is unknown"
"""What a lenient reader says of a date that the calendar does not have."""

DAY_FIRST, MONTH_FIRST = "dd/mm", "mm/dd"

_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
_STANDARD = re.compile(r"[0-9]{1,2}/[0-9]{1,2}/([0-9]{4}|[0-9]{2}),[0-9]{1,2}(:[0-9]{1,2}){2}(\.[0-9]{1,9})?")
_WRITTEN = re.compile(
    r"[ ,]*(?P<first>[0-9]{1,4}|[A-Za-z]{3,9}) *(?P<by>[-/. ]) *(?P<second>[0-9]{1,2}|[A-Za-z]{3,9})"
    r" *(?:(?P=by)|,) *(?P<third>[0-9]{1,4})"
    r"(?:[ ,;]+|T)(?P<hour>[0-9]{1,2}) *: *(?P<minute>[0-9]{1,2}) *: *(?P<second_s>[0-9]{1,2})"
    r"(?:[.,:](?P<fraction>[0-9]{1,9}))? *(?P<half>[AaPp][Mm])?(?P<utc>Z)?[ ,]*",
    re.ASCII,
)
_FRACTION = re.compile(r"\.([0-9]{1,9})", re.ASCII)
_MONTHS = (
    "january", "february", "march", "april", "may", "june", "july", "august", "september", "october",
    "november", "december",
)  # fmt: skip
_FEWEST_LETTERS = 3
_NOON_H = 12


@dataclass(frozen=True, slots=True)
class Moment:
    """A date and time as written.

    Parameters
    ----------
    ns : int or None
        Nanoseconds since 1970 in the file's own time zone; None where a lenient reader could not tell.
    decimals : int
        Number of decimals of the seconds.
    is_utc : bool, default False
        Whether the date itself says that it is UTC, by a Z.
    """

    ns: int | None
    decimals: int
    is_utc: bool = False


def record_times(start: Line, trigger: Line, revision: int, repairs: Repairs) -> tuple[Moment, Moment]:
    """Read the times of the first sample and of the trigger.

    A lenient reader takes a date that the calendar does not have for unknown.

    Parameters
    ----------
    start, trigger : Line
        The two lines.
    revision : int
        Year of the edition: 1991 writes the month before the day.
    repairs : Repairs
        Collects what was mended, and what departs from the standard.

    Returns
    -------
    start, trigger : Moment
        The dates and times.

    Raises
    ------
    RecordingError
        If a line holds no date and time between 1970 and 2200, and the reader is strict.
    """
    orders = (MONTH_FIRST, DAY_FIRST) if revision == 1991 else (DAY_FIRST, MONTH_FIRST)
    dates = [(line, _as_written(line)) for line in (start, trigger)]
    fitting = (order for order in orders if all(_is_date(*one, order) for one in dates))
    order = next(fitting, orders[0])
    first, second = (_moment(*one, order, revision, repairs) for one in dates)
    return first, second


def _is_date(line: Line, written: re.Match[str] | None, order: str) -> bool:
    """Whether the line is a date in this order; one in no form at all speaks against neither."""
    return written is None or isinstance(_of_calendar(line, written, order), datetime)


def _as_written(line: Line) -> re.Match[str] | None:
    """Return the parts of a date; quotes around it or its fields mean nothing."""
    return _WRITTEN.fullmatch(line.joined.replace('"', ""))


def _moment(line: Line, written: re.Match[str] | None, order: str, revision: int, repairs: Repairs) -> Moment:
    form = f"{'mm/dd/yy' if revision == 1991 else 'dd/mm/yyyy'},hh:mm:ss.ssssss"
    if written is None or (written["utc"] and revision >= 2013):  # 2013 has a line of its own for that
        fault = line.refuse("", form, line.quoted())
        repairs.mend(fault, UNKNOWN)
        fraction = _FRACTION.search(line.joined)
        return Moment(None, len(fraction[1]) if fraction else 0)
    decimals = len(written["fraction"] or "")
    moment = _of_calendar(line, written, order)
    if isinstance(moment, RecordingError):
        repairs.mend(moment, UNKNOWN)
        return Moment(None, decimals)
    if not _is_standard(line, written, order, revision):
        fault = line.refuse("", form, line.quoted())
        repairs.warn(f"{fault}: read as {moment:%Y-%m-%d %H:%M:%S}")
    elapsed = moment - _EPOCH
    elapsed_s = elapsed.days * SECONDS_PER_DAY + elapsed.seconds
    ns = elapsed_s * NANOSECONDS_PER_SECOND + int((written["fraction"] or "").ljust(9, "0"))
    return Moment(ns, decimals, is_utc=bool(written["utc"]))


def _is_standard(line: Line, written: re.Match[str], order: str, revision: int) -> bool:
    """Whether a date is in the edition's form; 1991 gives years of four digits, too, as many relays do."""
    if not _STANDARD.fullmatch(line.joined):
        return False
    if revision == 1991:
        return order == MONTH_FIRST
    return order == DAY_FIRST and len(written["third"]) == 4


def _of_calendar(line: Line, written: re.Match[str], order: str) -> datetime | RecordingError:
    """Return the date, or why it is none."""
    first, second, third = written["first"], written["second"], written["third"]
    if len(first) == 4 and first.isdigit():
        year, month, day = first, second, third
        if month.isdigit() and int(month) > len(_MONTHS):
            month, day = day, month
    elif second.isalpha() or (first.isdigit() and order == DAY_FIRST):
        day, month, year = first, second, third
    else:
        month, day, year = first, second, third
    if month.isalpha():
        named = [k for k, one in enumerate(_MONTHS, 1) if one.startswith(month.lower())]
        if len(named) != 1 or len(month) < _FEWEST_LETTERS:
            return line.refuse("month", "the name of a month, or its first three letters", month)
        month = str(named[0])
    if len(year) not in (2, 4) or len(day) > 2:
        return line.refuse("year", "two or four digits", year)
    full = int(year)
    if len(year) == 2:  # two digits of a format born in 1991; its files reach into this century
        full += 1900 if full >= 70 else 2000
    if not 1970 <= full <= 2200:
        return line.refuse("year", "1970 to 2200", str(full))
    hour = int(written["hour"])
    if half := written["half"]:
        if not 1 <= hour <= _NOON_H:
            return line.refuse("hour", f"1 to 12 before {half}", str(hour))
        hour = hour % _NOON_H + _NOON_H * (half.lower() == "pm")
    time = (hour, int(written["minute"]), int(written["second_s"]))
    try:
        return datetime(full, int(month), int(day), *time, tzinfo=UTC)
    except ValueError as error:
        expected = f"a date and time, {order}/yyyy,hh:mm:ss.ssssss"
        return line.refuse("", expected, f"{line.quoted()} ({error})")
