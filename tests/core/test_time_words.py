"""Times and durations are as people write them."""

import pytest

from core.time_words import clock, day, duration, time_ahead
from core.units import NANOSECONDS_PER_HOUR


@pytest.mark.parametrize(
    ("seconds", "expected"),
    [(0.4, "0 seconds"), (1.9, "1 second"), (119, "119 seconds"), (120, "2 minutes"), (7199, "119 minutes"),
     (7200, "2 hours"), (172_800, "2 days"), (800 * 86_400, "2 years")],
)  # fmt: skip
def test_a_duration_in_its_largest_unit(seconds: float, expected: str) -> None:
    assert duration(seconds) == expected


@pytest.mark.parametrize(
    ("days", "expected"),
    [
        (0.0, "an hour"),
        (0.04, "an hour"),
        (1.4, "34 hours"),
        (1.99, "48 hours"),
        (2.0, "2 days"),
        (9.4, "9 days"),
    ],
)
def test_a_time_ahead_is_rounded(days: float, expected: str) -> None:
    assert time_ahead(days) == expected


@pytest.mark.parametrize(
    ("hours", "zone", "expected"),
    [
        (0, "UTC", "1970-01-01 00:00 UTC"),
        (-1, "UTC", "1969-12-31 23:00 UTC"),
        (23, "Europe/Berlin", "1970-01-02 00:00 CET"),
        (24 * 182, "Europe/Paris", "1970-07-02 01:00 CET"),
        (24 * 182, "America/New_York", "1970-07-01 20:00 EDT"),
    ],
)
def test_a_time_as_the_clocks_of_a_zone_show_it(hours: int, zone: str, expected: str) -> None:
    assert clock(hours * NANOSECONDS_PER_HOUR, zone) == expected
    assert day(hours * NANOSECONDS_PER_HOUR, zone) == expected[:10]
