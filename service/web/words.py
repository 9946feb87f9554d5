"""Figures, times and terms as pages write them."""

from collections.abc import Mapping, Sequence
from math import isfinite
from typing import Final

from core.terms import phrase
from core.time_stamps import rfc3339
from core.time_words import clock, day, duration
from core.units import NANOSECONDS_PER_SECOND

__all__ = ["age", "day", "duration", "figure", "interval", "percent", "phrase", "rfc3339", "size", "utc"]

NOTHING: Final = "–"
"""Stands where a figure is not known."""

STATE_WORDS: Final[Mapping[str, str]] = {
    "healthy": "healthy",
    "watch": "watch",
    "fault": "fault",
    "unknown": "unknown",
    "stale": "no recent record",
    "not-running": "not running",
}
"""What people read beside the icon of a motor's state."""


def percent(share: float | None, digits: int = 2) -> str:
    """Return a share, such as a fault level, in per cent."""
    if share is None or not isfinite(share):
        return NOTHING
    return f"{100 * share:z.{digits}f} %".replace("-", "\N{MINUS SIGN}")


def interval(ends: Sequence[float] | None, digits: int = 2) -> str:
    """Return a 95 % interval of a share in per cent."""
    if ends is None or not all(isfinite(end) for end in ends):
        return NOTHING
    low, high = (f"{100 * end:z.{digits}f}".replace("-", "\N{MINUS SIGN}") for end in ends)
    return f"{low} to {high} %"


def figure(value: float | None, unit: str = "", digits: int = 3) -> str:
    """Return a figure with so many significant digits and its unit."""
    if value is None or not isfinite(value):
        return NOTHING
    text = f"{value:.{digits}g}"
    if "e" in text:
        text = f"{value:.0f}" if abs(value) >= 1.0 else f"{value:.{digits - 1}e}"
    return f"{text} {unit}".rstrip().replace("-", "\N{MINUS SIGN}")


def utc(time_ns: int | None) -> str:
    """Return a time to the minute, in UTC."""
    return NOTHING if time_ns is None else clock(time_ns)


def age(time_ns: int | None, now_ns: int) -> str:
    """Return how long ago a time was, in words."""
    if time_ns is None:
        return "never"
    seconds = (now_ns - time_ns) / NANOSECONDS_PER_SECOND
    return f"in {duration(-seconds)}" if seconds < -1.0 else f"{duration(seconds)} ago"


def size(number: int) -> str:
    """Return a number of bytes."""
    for factor, unit in ((1e9, "GB"), (1e6, "MB"), (1e3, "kB")):
        if number >= factor:
            return f"{number / factor:.3g} {unit}"
    return f"{number} bytes"
