"""Times, and how long something lasts, as people read them."""

import re
from datetime import UTC, datetime
from typing import Final
from zoneinfo import ZoneInfo

from core.units import NANOSECONDS_PER_SECOND, SECONDS_PER_DAY, SECONDS_PER_HOUR, SECONDS_PER_MINUTE

UNITS: Final = (
    (365.25 * SECONDS_PER_DAY, "year"),
    (SECONDS_PER_DAY, "day"),
    (SECONDS_PER_HOUR, "hour"),
    (SECONDS_PER_MINUTE, "minute"),
)
MANY: Final = 2.0
"""A duration is told in the largest unit that it has at least so often."""

_RFC3339_IN_SENTENCE: Final = re.compile(r"\b\d{4}-\d\d-\d\dT\d\d:\d\d(?P<seconds>:\d\d)?Z")

HOURS_PER_DAY: Final = SECONDS_PER_DAY / SECONDS_PER_HOUR


def clock(time_ns: int, zone: str | None = "UTC", *, seconds: bool = False) -> str:
    """Return a time as the clocks of a zone show it, with how far they are ahead of UTC.

    Parameters
    ----------
    time_ns : int
        Time, UTC [ns].
    zone : str or None
        Name of the time zone, such as Europe/Berlin. None: that of this machine.
    seconds : bool
        To the second; otherwise to the minute.

    Returns
    -------
    str
        The time, such as 2026-01-31 13:00 +01:00, or 2026-01-31 12:00 UTC.
    """
    at = _local(time_ns, zone)
    return f"{at:%Y-%m-%d %H:%M:%S} {_offset(at)}" if seconds else f"{at:%Y-%m-%d %H:%M} {_offset(at)}"


def with_clock_times(sentence: str, zone: str | None = "UTC") -> str:
    """Return a sentence with its RFC 3339 times as `clock` writes them, each as precise as it was.

    Times with a fraction of a second stay: whoever gives them compares clocks.

    Parameters
    ----------
    sentence : str
        The sentence, with times such as 2026-01-31T12:00:00Z.
    zone : str or None
        Name of the time zone. None: that of this machine.

    Returns
    -------
    str
        The sentence, with times such as 2026-01-31 13:00:00 +01:00.
    """

    def written(found: re.Match[str]) -> str:
        try:
            at = datetime.fromisoformat(found[0])
        except ValueError:  # it looks like a time, and is none
            return found[0]
        time_ns = int(at.timestamp()) * NANOSECONDS_PER_SECOND
        return clock(time_ns, zone, seconds=found["seconds"] is not None)

    return _RFC3339_IN_SENTENCE.sub(written, sentence)


def day(time_ns: int, zone: str = "UTC") -> str:
    """Return the day of a time as the clocks of a zone show it.

    Parameters
    ----------
    time_ns : int
        Time, UTC [ns].
    zone : str
        Name of the time zone.

    Returns
    -------
    str
        The day, such as 2026-01-31.
    """
    return f"{_local(time_ns, zone):%Y-%m-%d}"


def duration(seconds: float) -> str:
    """Return how long something lasts, rounded down.

    Parameters
    ----------
    seconds : float
        How long it is [s].

    Returns
    -------
    str
        The duration, such as 3 days.
    """
    for length, unit in UNITS:
        if seconds >= MANY * length:
            return f"{int(seconds / length)} {unit}s"
    whole = max(int(seconds), 0)
    return "1 second" if whole == 1 else f"{whole} seconds"


def time_ahead(days: float) -> str:
    """Return how long it is until something that is likely to come: an hour, some hours, or days.

    Parameters
    ----------
    days : float
        How long it is [d].

    Returns
    -------
    str
        The time, such as 34 hours or 9 days.
    """
    if days * HOURS_PER_DAY < 1.0:
        return "an hour"
    return f"{days * HOURS_PER_DAY:.0f} hours" if days < MANY else f"{days:.0f} days"


def _local(time_ns: int, zone: str | None) -> datetime:
    seconds = time_ns // NANOSECONDS_PER_SECOND
    if zone is None:
        return datetime.fromtimestamp(seconds, UTC).astimezone()
    return datetime.fromtimestamp(seconds, ZoneInfo(zone))


def _offset(at: datetime) -> str:
    ahead = f"{at:%z}"
    return f"{ahead[:3]}:{ahead[3:5]}" if at.utcoffset() else "UTC"
