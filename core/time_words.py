"""Times, and how long something lasts, as people read them."""

from datetime import datetime
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

HOURS_PER_DAY: Final = SECONDS_PER_DAY / SECONDS_PER_HOUR


def clock(time_ns: int, zone: str = "UTC") -> str:
    """Return a time to the minute as the clocks of a zone show it, with the zone's short name.

    Parameters
    ----------
    time_ns : int
        Time, UTC [ns].
    zone : str
        Name of the time zone, such as Europe/Berlin.

    Returns
    -------
    str
        The time, such as 2026-01-31 13:00 CET.
    """
    at = _local(time_ns, zone)
    return f"{at:%Y-%m-%d %H:%M} {at.tzname()}"


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


def _local(time_ns: int, zone: str) -> datetime:
    return datetime.fromtimestamp(time_ns // NANOSECONDS_PER_SECOND, ZoneInfo(zone))
