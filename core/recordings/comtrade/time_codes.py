"""How far the times of a COMTRADE file are ahead of UTC: the two lines that 2013 adds (7.4.11, 7.4.12)."""

import re

from core.recordings.comtrade.lines import Line, Lines
from core.recordings.errors import RecordingError, quoted
from core.recordings.repairs import Repairs
from core.units import NANOSECONDS_PER_SECOND

_STANDARD = re.compile(r"([+-]?)([0-9]{1,2})(?:h([0-9]{1,2}))?", re.ASCII)
_OTHER = re.compile(
    r"(?:UTC|GMT)? *([+-]?) *([0-9]{1,2})(?: *[h:] *(?:([0-9]{2}) *(?:m|min)?)?)?", re.ASCII | re.IGNORECASE
)
_FOUR_DIGITS = re.compile(r"(?:UTC|GMT)? *([+-]) *([0-9]{2})([0-9]{2})", re.ASCII | re.IGNORECASE)
_DECIMAL = re.compile(r"([+-]?)([0-9]{1,2})\.(0|00|25|5|50|75)", re.ASCII)
"""There is one way to read +5h, +05:30, UTC+1, +0530 and +5.5."""
_ZERO = ("z", "utc", "gmt")
_MOST_H, _MOST_MIN = 14, 59


def utc_offset_ns(lines: Lines, repairs: Repairs) -> int | None:
    """Read the two lines with which a file of 2013 ends: the time code and the quality of the time.

    A lenient reader takes the times for UTC where the lines are missing, and for unknown where the time code
    is none.

    Parameters
    ----------
    lines : Lines
        The lines of the file, up to these two.
    repairs : Repairs
        Collects what was mended, and what departs from the standard.

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
        offset = _utc_offset(line.of(2, repairs=repairs), repairs)
    except RecordingError as fault:
        repairs.mend(fault, "the times are unknown")
        offset = None
    try:
        _check_time_quality(lines.next("time quality and leap second").of(2, repairs=repairs))
    except RecordingError as fault:
        repairs.mend(fault, "the quality of the time is not looked at")
    return offset


def _utc_offset(line: Line, repairs: Repairs) -> int:
    """Return how far the times are ahead of UTC [ns]; "-5h30" is 5.5 hours behind."""
    code, local = line.fields
    minutes = _minutes(code)
    refusal = line.refuse("time code", "hours ahead of UTC such as 0, +1 or -5h30", quoted(code))
    if minutes is None:
        raise refusal
    if not _STANDARD.fullmatch(code):
        sign = "-" if minutes < 0 else "+"
        hours, rest = divmod(abs(minutes), 60)
        repairs.warn(f"{refusal}: read as {sign}{hours}h{rest:02}")
    if local.casefold() != "x" and _minutes(local) is None:
        raise line.refuse("local code", "hours ahead of UTC such as 0, +1 or -5h30, or x", quoted(local))
    return minutes * 60 * NANOSECONDS_PER_SECOND


def _minutes(code: str) -> int | None:
    """Minutes ahead of UTC; None where the code tells none."""
    if code.casefold() in _ZERO:
        return 0
    if decimal := _DECIMAL.fullmatch(code):
        quarters = int(decimal[3].ljust(2, "0")) * 60 // 100
        code = f"{decimal[1]}{decimal[2]}h{quarters:02}"
    parts = _STANDARD.fullmatch(code) or _OTHER.fullmatch(code) or _FOUR_DIGITS.fullmatch(code)
    if parts is None or int(parts[2]) > _MOST_H or int(parts[3] or 0) > _MOST_MIN:
        return None
    minutes = int(parts[2]) * 60 + int(parts[3] or 0)
    return -minutes if parts[1] == "-" else minutes


def _check_time_quality(line: Line) -> None:
    if not re.fullmatch(r"[0-9A-Fa-f]", line.fields[0], re.ASCII):
        raise line.refuse("time quality", "a hexadecimal digit", quoted(line.fields[0]))
    line.integer(1, "leap second", 0, 3)
