"""Times and durations are as people write them."""

import time

import pytest

from core.time_words import clock, day, duration, time_ahead, with_clock_times
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
        (23, "Europe/Berlin", "1970-01-02 00:00 +01:00"),
        (24 * 182, "Europe/Paris", "1970-07-02 01:00 +01:00"),
        (24 * 182, "America/New_York", "1970-07-01 20:00 -04:00"),
    ],
)
def test_a_time_as_the_clocks_of_a_zone_show_it(hours: int, zone: str, expected: str) -> None:
    assert clock(hours * NANOSECONDS_PER_HOUR, zone) == expected
    assert day(hours * NANOSECONDS_PER_HOUR, zone) == expected[:10]


@pytest.mark.parametrize(
    ("sentence", "expected"),
    [
        ("down since 2026-01-31T12:00:00Z: no answer", "down since 2026-01-31 13:00:00 +01:00: no answer"),
        ("values from 2026-07-01T12:00Z on only", "values from 2026-07-01 14:00 +02:00 on only"),
        ("2026-01-31T12:00:00.250Z", "2026-01-31T12:00:00.250Z"),
        ("2026-99-31T12:00:00Z", "2026-99-31T12:00:00Z"),
    ],
)
def test_times_of_a_sentence_as_the_clocks_of_a_zone_show_them(sentence: str, expected: str) -> None:
    assert with_clock_times(sentence, "Europe/Berlin") == expected


def test_without_a_zone_the_clock_is_that_of_this_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TZ", "Asia/Kolkata")
    time.tzset()
    assert clock(0, None, seconds=True) == "1970-01-01 05:30:00 +05:30"
    monkeypatch.undo()
    time.tzset()
