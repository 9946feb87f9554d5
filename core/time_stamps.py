"""Time stamps as text: RFC 3339 in UTC outside, integer nanoseconds inside."""

import re
import time
from datetime import UTC, datetime
from typing import Final

from core.units import NANOSECONDS_PER_SECOND, SECONDS_PER_DAY

MAX_NS: Final = 2**63 - 1
"""The largest time that 64 bits hold, in the year 2262."""

SECONDS_END: Final = len("2026-01-31T12:00:00")

MAX_LENGTH: Final = 64
"""Of the text of a time: all digits of a nanosecond and a few more."""

_DATE = re.compile(r"\d{4}-\d\d-\d\d", re.ASCII)
_RFC3339 = re.compile(r"(\d{4}-\d\d-\d\d)[Tt](\d\d:\d\d:\d\d)(?:\.(\d+))?([Zz]|[+-]\d\d:\d\d)", re.ASCII)


def rfc3339(time_ns: int) -> str:
    """Return a time as 2026-01-31T12:00:00.123456789Z; all nine digits, so that nothing is lost.

    Parameters
    ----------
    time_ns : int
        Time, UTC [ns].

    Returns
    -------
    str
        The time as text.
    """
    seconds, nanoseconds = divmod(time_ns, NANOSECONDS_PER_SECOND)
    # This takes half as long as a datetime's text.
    year, month, day, hour, minute, second, *_ = time.gmtime(seconds)
    return f"{year}-{month:02d}-{day:02d}T{hour:02d}:{minute:02d}:{second:02d}.{nanoseconds:09d}Z"


def nanoseconds(text: str) -> int:
    """Return an RFC 3339 time as UTC [ns]; a date alone is its beginning in UTC.

    Times beyond 64 bits are moved to the first or last that they hold.

    Parameters
    ----------
    text : str
        The time as text, in any zone, or a date.

    Returns
    -------
    int
        The time, UTC [ns].

    Raises
    ------
    ValueError
        If the text is no RFC 3339 time and no date.
    """
    if _DATE.fullmatch(text):
        text = f"{text}T00:00:00Z"
    match = _RFC3339.fullmatch(text) if len(text) <= MAX_LENGTH else None
    if match is None:
        raise ValueError(
            f"expected an RFC 3339 time such as 2026-01-31T12:00:00Z or a date such as 2026-01-31, "
            f"found {text[:MAX_LENGTH]!a}"
        )
    date, clock, fraction, zone = match.groups()
    leap = clock.endswith(":60")
    whole = datetime.fromisoformat(f"{date}T{clock[:-2] + '59' if leap else clock}{zone.upper()}")
    since_1970 = whole - datetime(1970, 1, 1, tzinfo=UTC)
    seconds = since_1970.days * SECONDS_PER_DAY + since_1970.seconds + leap
    time_ns = seconds * NANOSECONDS_PER_SECOND + int((fraction or "0")[:9].ljust(9, "0"))
    return max(-MAX_NS, min(MAX_NS, time_ns))
