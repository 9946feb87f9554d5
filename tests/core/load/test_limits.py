"""Hours beyond limits, counted by hand."""

from core.load.course import NANOSECONDS_PER_HOUR as HOUR
from core.load.limits import DatedValue, HoursBeyond, hours_beyond

VALUES = [(0, 1.0), (1, 1.3), (2, 1.2), (3, 0.9), (4, 1.5), (6, None), (7, 1.4)]


def of(limit: float, *, below: bool = False) -> HoursBeyond:
    """Hours beyond a limit in ten hours, in which a value holds for an hour."""
    values = [DatedValue(hour * HOUR, value) for hour, value in VALUES]
    return hours_beyond(values, limit, until_ns=10 * HOUR, longest_ns=HOUR, below=below)


def test_hours_above_with_gaps_and_the_longest_time_without_a_break() -> None:
    assert of(1.1) == HoursBeyond(hours=4.0, known_hours=6.0, longest_hours=2.0, worst=1.5)


def test_hours_below() -> None:
    assert of(1.0, below=True) == HoursBeyond(hours=1.0, known_hours=6.0, longest_hours=1.0, worst=0.9)


def test_nothing_beyond() -> None:
    assert of(2.0) == HoursBeyond(hours=0.0, known_hours=6.0, longest_hours=0.0, worst=None)
