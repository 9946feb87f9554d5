"""Where an axis has its marks, and what is written at them."""

from collections.abc import Sequence
from datetime import UTC, datetime, timedelta, tzinfo
from math import ceil, floor, log10

from core.units import NANOSECONDS_PER_SECOND

STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)

SPANS = (
    *(timedelta(minutes=number) for number in (1, 2, 5, 10, 15, 30)),
    *(timedelta(hours=number) for number in (1, 2, 3, 6, 12)),
    *(timedelta(days=number) for number in (1, 2, 7, 14, 28, 91, 182, 364, 728, 1820, 3640)),
)
LONG = timedelta(days=364)


def figure_ticks(least: float, largest: float, most: int) -> Sequence[float]:
    """Return round figures between two, at most so many."""
    rough = (largest - least) / max(most, 1)
    if not rough > 0.0:
        return [least]
    power = 10.0 ** floor(log10(rough))
    step = next((one * power for one in STEPS if one * power >= rough), 10.0 * power)
    return [number * step for number in range(ceil(least / step), floor(largest / step + 1e-9) + 1)]


def time_ticks(first_ns: int, last_ns: int, most: int, zone: tzinfo = UTC) -> Sequence[tuple[int, str]]:
    """Return times between two [ns] with what is written at them, at most so many, in a time zone."""
    span = timedelta(microseconds=max(last_ns - first_ns, 0) / 1000)
    step = next((one for one in SPANS if one * most >= span), SPANS[-1])
    begin = datetime.fromtimestamp(first_ns / NANOSECONDS_PER_SECOND, zone)
    at = begin.replace(hour=0, minute=0, second=0, microsecond=0)
    if step < timedelta(days=1):
        at += step * floor((begin - at) / step)
    form = "%H:%M" if step < timedelta(days=1) else ("%Y-%m-%d" if step >= LONG else "%d %b")
    found: list[tuple[int, str]] = []
    while (time_ns := round(at.timestamp()) * NANOSECONDS_PER_SECOND) <= last_ns and len(found) <= most:
        if time_ns >= first_ns:
            found.append(
                (time_ns, f"{at:%d %b}" if form == "%H:%M" and at.hour + at.minute == 0 else f"{at:{form}}")
            )
        at += step
    return found
